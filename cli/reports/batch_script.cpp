#include "cli/reports/batch_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ensemble/statistics/finite_text.hpp"
#include "results/disk/printable.hpp"
#include "study/provenance.hpp"

namespace jostle::inline cli {
namespace {

/// Restarts after which the script no longer requeues itself, so that a run without progress ends.
std::uint64_t most_restarts(const JobPlan& plan) {
  constexpr std::uint64_t at_least = 10, of_the_estimate = 3;
  return std::max(at_least, of_the_estimate * plan.starts);
}

std::string header(const BatchScript& script, const JobPlan& plan) {
  const std::pair<const char*, std::string> options[] = {
      {"job-name", script.name},
      {"array", fmt::format("1-{}", plan.tasks)},
      {"nodes", "1"},
      {"ntasks", "1"},
      {"cpus-per-task", fmt::to_string(script.cpus)},
      {"time", slurm_time(script.time_limit)},
      {"mem", fmt::format("{}M", script.megabytes)},
      {"signal", finite_text("B:USR1@{:.0f}", plan.notice.count())},
      {"open-mode", "append"},
      {"output", script.name + ".slurm.log"},
      {"chdir", script.folder}};
  std::string text = fmt::format(
      "#!/bin/bash\n"
      "# {}. Made by\n"
      "#   {}\n"
      "# {}\n"
      "# Submit with sbatch. Options of its command line (-p, -A, --array, ...) override those "
      "here.\n"
      "# Submit this file any number of times: finished work is not repeated.\n",
      script.name, printable_name(script.made_by), printable_name(script.estimate));
  for (const auto& [option, value] : options)
    text += fmt::format("#SBATCH --{}={}\n", option, shell_words({value}));
  return text + "#SBATCH --requeue\n";
}

// A signal interrupts bash's `wait`, which then must wait again for the run's own exit code. There
// is no $(...) behind the traps: bash 5.2 fails where a trap comes while it reads one.
constexpr const char* body = R"BASH(
# Where another user's link leads, that user chooses.
if [ -L "$results" ] && [ "$(stat -c %u -- "$results")" != "$EUID" ]; then
  printf '%s is a link of another user and is not followed: name the folder itself\n' "$results"
  exit 4
fi
mkdir -p -- "$results" || exit 4
# jostle status reads the copy.
cp --remove-destination -- "$0" "$results/.job.$SLURM_JOB_ID" &&
  mv -fT -- "$results/.job.$SLURM_JOB_ID" "$results/job.sbatch"

job=${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID
log_line() { printf '%(%F %T)T job %s on %s: %s\n' -1 "$job" "$HOSTNAME" "$*"; }
run= stopped= out_of_time=
pass_on() { interrupted=yes stopped=$1; [ -z "$run" ] || kill -s "$1" "$run"; }
trap 'out_of_time=yes; pass_on USR1' USR1
trap 'pass_on TERM' TERM

worst=0 left=
for ((shard = (SLURM_ARRAY_TASK_ID - 1) * a_task + 1, last = shard + a_task - 1;
      shard <= last && shard <= shards; ++shard)); do
  if [ -n "$stopped" ]; then left=yes; break; fi
  if [ -L "$results/$shard.log" ]; then
    log_line "$results/$shard.log is a link, and logs are not written through links: remove it"
    worst=4
    continue
  fi
  "$jostle" run --resume --shard "$shard/$shards" --output="$results/$shard.h5" --no-progress \
    -- "$scene" >>"$results/$shard.log" 2>&1 &
  run=$!
  [ -z "$stopped" ] || kill -s "$stopped" "$run"
  while interrupted=; wait "$run"; code=$?; [ -n "$interrupted" ]; do :; done
  # Bash loses the code of a run that ends just as a signal arrives (-1 or 127): a resume finds what is left.
  if [ -n "$stopped" ] && { [ "$code" = -1 ] || [ "$code" = 127 ]; }; then code=75; fi
  run=
  case $code in
    0) log_line "shard $shard of $shards is done" ;;
    75) log_line "shard $shard of $shards is stopped"; left=yes; break ;;
    *) log_line "shard $shard of $shards: exit code $code, see $results/$shard.log"; worst=$code ;;
  esac
done

[ -n "$left" ] || exit $worst
trap '' USR1 TERM
if [ -z "$out_of_time" ]; then
  log_line "stopped before its time limit: not requeued"
elif [ "${SLURM_RESTART_COUNT:-0}" -ge "$most_restarts" ]; then
  log_line "out of time after $most_restarts restarts: not requeued again"
elif scontrol requeue "$job"; then
  log_line "out of time, requeued"
else
  log_line "out of time, and requeueing failed: submit it again"
fi
exit 75
)BASH";

}  // namespace

std::string slurm_time(Seconds time) {
  const auto minutes = static_cast<std::uint64_t>(std::ceil(time.count() / 60 - 1e-6));
  const std::uint64_t days = minutes / 1440, hours = minutes / 60 % 24;
  const std::string clock = fmt::format("{:02}:{:02}:00", hours, minutes % 60);
  return days > 0 ? fmt::format("{}-{}", days, clock) : clock;
}

std::string slurm_script(const BatchScript& script, const JobPlan& plan) {
  const std::string variables = fmt::format(
      "\n"
      "shards={} a_task={} most_restarts={}\n"
      "scene={}\n"
      "results={}\n"
      "jostle={}\n",
      plan.shards, plan.shards_a_task, most_restarts(plan), shell_words({script.scene}),
      shell_words({script.results}), shell_words({script.program}));
  return header(script, plan) + variables + body;
}

}  // namespace jostle::inline cli
