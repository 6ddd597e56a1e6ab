#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "results/file/results_file_impl.hpp"
#include "results/groups/axes.hpp"

namespace jostle::inline results {

/// A realization of a file that outlives it.
class ResultsFile::Stored : public StoredRealization {
 public:
  Stored(const ResultsFile& file, RealizationId id, Content content)
      : file_(file), impl_(*file.impl_), id_(id), content_(content) {}

  RealizationHead head() override {
    return naming_file(impl_.path, [&] {
      const PointTables& tables = impl_.tables(id_.point);
      return RealizationHead{static_cast<RealizationStatus>(tables.statuses.at(id_.realization)),
                             tables.reasons.at(id_.realization), tables.work.at(id_.realization),
                             file_.restart_state(id_)};
    });
  }
  std::uint64_t n_rows() const override {
    return naming_file(impl_.path,
                       [&] { return impl_.tables(id_.point).rows.at(id_.realization); });
  }
  void read_rows(std::uint64_t first, std::span<double> rows) override;
  std::vector<SnapshotOutline> snapshots() override;
  std::vector<Vec3> vectors(std::uint64_t tap, std::size_t index) override;
  std::vector<double> profile(std::uint64_t tap, std::size_t index) override;
  std::vector<Contact> contacts(std::uint64_t tap) override;

 private:
  const StudyPoint& point() const { return file_.study().points.at(id_.point); }

  const ResultsFile& file_;
  Impl& impl_;
  RealizationId id_;
  Content content_;
};

void ResultsFile::Stored::read_rows(std::uint64_t first, std::span<double> rows) {
  naming_file(impl_.path, [&] {
    const std::size_t n_columns = impl_.n_columns(id_.point), n = impl_.study.realizations;
    const std::uint64_t a_block = impl_.block_rows(id_.point);
    for (std::size_t i = 0; i < rows.size() / n_columns; ++i) {
      const auto& columns = impl_.row_block(id_.point, first + i);
      for (std::size_t c = 0; c < n_columns; ++c)
        rows[i * n_columns + c] = columns.at(c).at((first + i) % a_block * n + id_.realization);
    }
  });
}

/// Where profiles were kept and nothing else, every snapshot tap that was reached may have one.
std::vector<SnapshotOutline> ResultsFile::Stored::snapshots() {
  if (content_ == Content::without_snapshots) return {};
  return naming_file(impl_.path, [&] {
    const PointTables& tables = impl_.tables(id_.point);
    const auto& taps = point().snapshots.taps;
    std::map<std::uint64_t, SnapshotOutline> by_tap;
    const ParticleFrames& frames = impl_.frames(id_);
    for (std::size_t k = 0; k < n_sphere_vectors; ++k)
      for (const std::uint64_t tap : frames.taps(k)) by_tap[tap].n_spheres[k] = point().n_spheres;
    for (auto& [tap, outline] : by_tap) outline.n_contacts = frames.network().n_contacts(tap);
    const bool has_profiles = std::ranges::max(tables.n_bins) > 0;
    for (std::size_t s = 0; s < taps.size(); ++s) {
      const std::size_t cell = s * file_.study().realizations + id_.realization;
      const bool coordinated =
          !tables.coordination.empty() && !std::isnan(tables.coordination.at(cell));
      if (coordinated) by_tap[taps[s]].coordination = tables.coordination[cell];
      if (!tables.forces.empty() && tables.forces.at(cell))
        by_tap[taps[s]].forces = tables.forces[cell];
      if (has_profiles && taps[s] < tables.rows.at(id_.realization)) by_tap[taps[s]];
    }
    std::vector<SnapshotOutline> outlines;
    for (auto& [tap, outline] : by_tap) {
      outline.tap = tap;
      outlines.push_back(outline);
    }
    return outlines;
  });
}

std::vector<Vec3> ResultsFile::Stored::vectors(std::uint64_t tap, std::size_t index) {
  if (content_ == Content::without_snapshots) return {};
  return naming_file(impl_.path, [&] { return impl_.frames(id_).vectors(tap, index); });
}

std::vector<Contact> ResultsFile::Stored::contacts(std::uint64_t tap) {
  if (content_ == Content::without_snapshots) return {};
  return naming_file(impl_.path, [&] { return impl_.frames(id_).network().contacts(tap); });
}

std::vector<double> ResultsFile::Stored::profile(std::uint64_t tap, std::size_t index) {
  return naming_file(impl_.path, [&]() -> std::vector<double> {
    const auto& taps = point().snapshots.taps;
    const auto found = std::ranges::lower_bound(taps, tap);
    if (content_ == Content::without_snapshots || found == taps.end() || *found != tap) return {};
    auto bins = impl_.profile(id_, static_cast<std::size_t>(found - taps.begin()), index);
    // The last bin of a profile holds spheres: what follows is padding, or none was kept.
    const auto is_none = [&](double value) {
      return std::isnan(value) || value == height_profiles[index].padding;
    };
    while (!bins.empty() && is_none(bins.back())) bins = bins.first(bins.size() - 1);
    return {bins.begin(), bins.end()};
  });
}

std::unique_ptr<StoredRealization> ResultsFile::realization(RealizationId id,
                                                            Content content) const {
  if (id.realization >= study().realizations) return in_memory();
  if (!naming_file(impl_->path, [&] { return impl_->has_point(id.point); })) return in_memory();
  return std::make_unique<Stored>(*this, id, content);
}

}  // namespace jostle::inline results
