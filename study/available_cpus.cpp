#include "study/available_cpus.hpp"

#if defined(__linux__) && !defined(JOSTLE_PORTABLE)
#include <sched.h>
#endif

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>

namespace jostle::inline study {
namespace {

namespace fs = std::filesystem;

std::optional<double> quota_of_version_2(const fs::path& group) {
  std::ifstream file(group / "cpu.max");
  std::string quota;
  double period = 0;
  if (!(file >> quota >> period) || quota == "max" || period <= 0) return {};
  return std::strtod(quota.c_str(), nullptr) / period;
}

std::optional<double> quota_of_version_1(const fs::path& group) {
  double quota = 0, period = 0;
  if (!(std::ifstream(group / "cpu.cfs_quota_us") >> quota)) return {};
  if (!(std::ifstream(group / "cpu.cfs_period_us") >> period)) return {};
  if (quota <= 0 || period <= 0) return {};
  return quota / period;
}

/// The least quota of a group and its parents up to the mount.
template <class QuotaOf>
std::optional<double> tightest(const fs::path& mount, fs::path group, QuotaOf quota_of) {
  std::optional<double> least;
  group = group.relative_path();
  while (true) {
    const auto quota = quota_of(mount / group);
    if (quota) least = std::min(*quota, least.value_or(*quota));
    if (group.empty()) return least;
    group = group.parent_path();
  }
}

bool lists_cpu(std::string_view controllers) {
  while (!controllers.empty()) {
    const auto comma = controllers.find(',');
    if (controllers.substr(0, comma) == "cpu") return true;
    if (comma == std::string_view::npos) return false;
    controllers.remove_prefix(comma + 1);
  }
  return false;
}

std::optional<int> affinity() {
#if defined(__linux__) && !defined(JOSTLE_PORTABLE)
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  return {};  // another system, or more than 1024 CPUs
}

std::optional<int> slurm_cpus() {
  const char* text = std::getenv("SLURM_CPUS_PER_TASK");
  if (text == nullptr) return {};
  int cpus = 0;
  const std::string_view digits = text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), cpus);
  if (error != std::errc{} || end != digits.data() + digits.size() || cpus < 1) return {};
  return cpus;
}

}  // namespace

std::optional<double> cgroup_quota(const fs::path& self, const fs::path& mount) {
  std::ifstream file(self);
  std::optional<double> least;
  for (std::string line; std::getline(file, line);) {  // "hierarchy:controllers:path"
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path group = line.substr(second + 1);
    std::optional<double> quota;
    if (controllers.empty()) quota = tightest(mount, group, quota_of_version_2);
    if (lists_cpu(controllers)) quota = tightest(mount / "cpu", group, quota_of_version_1);
    if (quota) least = std::min(*quota, least.value_or(*quota));
  }
  return least;
}

int available_cpus() {
  int cpus = affinity().value_or(static_cast<int>(std::thread::hardware_concurrency()));
  if (const auto quota = cgroup_quota("/proc/self/cgroup", "/sys/fs/cgroup")) {
    cpus = std::min(cpus, static_cast<int>(std::ceil(*quota)));
  }
  if (const auto slurm = slurm_cpus()) cpus = std::min(cpus, *slurm);
  return std::max(cpus, 1);
}

}  // namespace jostle::inline study
