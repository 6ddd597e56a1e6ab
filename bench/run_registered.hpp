#pragma once

#include <benchmark/benchmark.h>

namespace jostle::bench {

/// The main function of a program of benchmarks: reads the library's options, registers, runs.
inline int run_registered(int argc, char** argv, void (*register_all)()) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  register_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace jostle::bench
