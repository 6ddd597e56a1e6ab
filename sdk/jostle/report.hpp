#pragma once

// Results as one HTML page.

#include "study/drawing/page/page.hpp"
