#include "study/available_cpus.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <string>

using namespace jostle;
namespace fs = std::filesystem;

namespace {

/// A folder that stands for /proc/self/cgroup and /sys/fs/cgroup.
class Machine {
 public:
  Machine() : root_(fs::temp_directory_path() / ("jostle-cpus-" + std::to_string(getpid()))) {
    fs::create_directories(root_);
  }
  ~Machine() { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  std::optional<double> quota() const { return cgroup_quota(root_ / "self", root_ / "cgroup"); }

 private:
  fs::path root_;
};

}  // namespace

TEST_CASE("The tightest quota of a version 2 group and its parents counts") {
  Machine machine;
  machine.write("self", "0::/a/b\n");
  machine.write("cgroup/a/b/cpu.max", "300000 100000\n");
  CHECK(machine.quota() == 3.0);
  machine.write("cgroup/a/cpu.max", "150000 100000\n");
  CHECK(machine.quota() == 1.5);
  machine.write("cgroup/cpu.max", "max 100000\n");
  CHECK(machine.quota() == 1.5);
}

TEST_CASE("Version 1 quotas are read from the cpu controller's own hierarchy") {
  Machine machine;
  machine.write("self", "9:memory:/job\n4:cpu,cpuacct:/job\n1:cpuset:/job\n");
  machine.write("cgroup/cpu/job/cpu.cfs_quota_us", "-1\n");
  machine.write("cgroup/cpu/job/cpu.cfs_period_us", "100000\n");
  CHECK_FALSE(machine.quota());
  machine.write("cgroup/cpu/cpu.cfs_quota_us", "250000\n");
  machine.write("cgroup/cpu/cpu.cfs_period_us", "100000\n");
  CHECK(machine.quota() == 2.5);
}

TEST_CASE("Without control groups there is no quota") {
  CHECK_FALSE(Machine().quota());
}

TEST_CASE("Slurm's share of a node limits the threads, nonsense does not") {
  unsetenv("SLURM_CPUS_PER_TASK");
  const int all = available_cpus();
  CHECK(all >= 1);
  setenv("SLURM_CPUS_PER_TASK", "1", 1);
  CHECK(available_cpus() == 1);
  setenv("SLURM_CPUS_PER_TASK", "1000000", 1);
  CHECK(available_cpus() == all);
  setenv("SLURM_CPUS_PER_TASK", "many", 1);
  CHECK(available_cpus() == all);
  unsetenv("SLURM_CPUS_PER_TASK");
}
