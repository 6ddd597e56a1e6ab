#include "study/running/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "study/provenance.hpp"
#include "study/running/stored_scene.hpp"

namespace jostle::inline study {
namespace {

/// An observer also receives an end by an exception.
template <class Tell>
class AtEnd {
 public:
  explicit AtEnd(Tell tell) : tell_(std::move(tell)) {}
  AtEnd(const AtEnd&) = delete;
  AtEnd& operator=(const AtEnd&) = delete;
  ~AtEnd() { tell_(); }

 private:
  Tell tell_;
};

}  // namespace

OutputExists::OutputExists(const std::string& path)
    : BadInput(path + " exists and is kept"), path_(path) {}

OtherScene::OtherScene(const std::string& path, const std::string& differences)
    : BadInput(fmt::format("{} was begun with another scene and cannot be resumed with this one:\n"
                           "{}",
                           path, differences)),
      path_(path),
      differences_(differences) {}

OtherShard::OtherShard(const std::string& path, const Shard& stored, const Shard& asked)
    : BadInput(fmt::format("{} holds shard {}/{}, not {}/{}", path, stored.index, stored.count,
                           asked.index, asked.count)),
      path_(path),
      stored_(stored),
      asked_(asked) {}

SceneRun::SceneRun(const LoadedScene& loaded, const RunSettings& settings, RunObserver& observer)
    : loaded_(loaded), settings_(settings), observer_(observer), study_(study_of(loaded)) {
  const bool resumes = settings.existing == Existing::resume;
  if (!loaded.scene.until.targets.empty() && settings.shard.count > 1) {
    throw BadArgument(
        Argument::shard, "",
        "this scene runs until a target precision is reached (\"until\"), which a shard, with a "
        "part of the realizations, cannot decide. Run it whole; or remove \"until\", run the "
        "shards, merge them, and resume the merged file with \"until\".");
  }
  const std::string& output = settings.output;
  const Provenance provenance = provenance_of_this_run(fmt::to_string(settings.threads));
  std::error_code unreadable;  // a ring of links, a name too long: reported when it is opened
  if (!std::filesystem::exists(output, unreadable) || settings.existing == Existing::replace) {
    store_ = RunStore::create(output, study_, settings.shard, provenance,
                              settings.existing == Existing::replace, settings.room,
                              settings.patience, settings.take_over);
    return;
  }
  if (!resumes) throw OutputExists(output);
  retry_failed_ = settings.retry_failed;
  store_ = RunStore::resume(
      output, [this](const ResultsFile& file) { return study_for(file); }, settings.shard,
      provenance, settings.take_over, settings.room, settings.patience);
  auto pending = store_->pending(retry_failed_);
  std::ranges::sort(pending);
  for (const RealizationSummary& realization : store_->realizations()) {
    const bool counts = realization.status == RealizationStatus::running &&
                        std::ranges::binary_search(pending, realization.id);
    if (counts) taps_recorded_ += realization.taps();
  }
}

/// The permitted changes of a resume; nothing else may differ from the file's scene.
Study SceneRun::study_for(const ResultsFile& file) {
  const std::string differences = scene_differences(file, loaded_);
  if (!differences.empty()) throw OtherScene(settings_.output, differences);
  if (file.shard() != settings_.shard) {
    throw OtherShard(settings_.output, file.shard(), settings_.shard);
  }
  tables_before_ = file.table_names();
  study_.realizations = std::max(study_.realizations, file.study().realizations);
  return study_;
}

bool SceneRun::compute(std::optional<std::uint32_t> first) {
  std::vector<RealizationId> pending = store_->pending(retry_failed_);
  retry_failed_ = false;
  if (first) {
    std::ranges::stable_sort(pending, [&](RealizationId a, RealizationId b) {
      return (a.point == *first) > (b.point == *first);
    });
  }
  const RunSummary made = run(pending);
  const bool is_complete = made.done + made.failed == pending.size();
  left_in_parts_ = !is_complete && store_->bytes_to_fold() > settings_.most_bytes_folded_at_stop;
  if (!left_in_parts_) fold();
  summary_.done += made.done;
  summary_.failed += made.failed;
  summary_.interrupted += made.interrupted;
  return is_complete;
}

RunSummary SceneRun::run(const std::vector<RealizationId>& pending) {
  observer_.computing(progress_, work_ahead(pending), pending.size(),
                      loaded_.plans.size() * study_.realizations);
  const AtEnd end([this] { observer_.computed(); });
  return run_ensemble(loaded_.plans, pending,
                      {.threads = settings_.threads,
                       .checkpoint_every = settings_.checkpoint_every,
                       .stop = settings_.stop},
                      *store_, progress_);
}

void SceneRun::fold() {
  const AtEnd end([this] { observer_.stored(); });
  store_->finish(
      [this](std::uint64_t done, std::uint64_t total) { observer_.storing(done, total); });
}

bool SceneRun::compute_until_precise() {
  const TargetPrecision& until = loaded_.scene.until;
  while (compute()) {
    if (until.targets.empty()) return true;
    const PrecisionStatus status = precision_status(results(), until);
    observer_.compared(status);
    if (status.next == status.realizations) return true;
    extend(status.next);
  }
  return false;
}

void SceneRun::extend(std::uint32_t realizations) {
  study_.realizations = realizations;
  taps_recorded_ = 0;
  store_->extend(realizations);
}

WorkAhead SceneRun::work_ahead(const std::vector<RealizationId>& pending) const {
  WorkAhead ahead{.realizations = pending.size(), .taps = 0, .unit = common_unit(study_)};
  for (const RealizationId& id : pending) ahead.taps += study_.points[id.point].taps;
  ahead.taps -= std::min(ahead.taps, taps_recorded_);
  ahead.realizations += progress_.realizations_done;
  ahead.taps += progress_.taps_done;
  return ahead;
}

ResultsFile SceneRun::close() {
  return RunStore::close(std::move(store_));
}

}  // namespace jostle::inline study
