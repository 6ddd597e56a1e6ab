#pragma once

// Levenberg-Marquardt fits of the laws, or of a model of your own, to a curve. jostle::fitting
// suffices to link.

#include "fitting/fit.hpp"
#include "fitting/models/limit.hpp"
#include "fitting/report.hpp"
