#pragma once

#include <filesystem>
#include <optional>

namespace jostle::inline study {

/// CPUs that this process may use: the least of its affinity mask, its cgroup's quota (rounded up)
/// and SLURM_CPUS_PER_TASK. At least 1.
int available_cpus();

/// The tightest CPU quota over the process's control groups and all their parents, in CPUs; nothing
/// without one. `self` is /proc/self/cgroup; `mount` is /sys/fs/cgroup, version 1 or 2 or both.
std::optional<double> cgroup_quota(const std::filesystem::path& self,
                                   const std::filesystem::path& mount);

}  // namespace jostle::inline study
