#pragma once

// The version of the program, its revision, and the libraries it was built with.

#include "study/version.hpp"
