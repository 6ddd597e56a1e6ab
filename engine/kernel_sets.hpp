#pragma once

// Defined where kernels are compiled for AVX2 and AVX-512 besides the baseline:
// engine/CMakeLists.txt compiles them under the same condition.
#if defined(__x86_64__) && !defined(JOSTLE_PORTABLE)
#define JOSTLE_X86_KERNELS
#endif
