#include "results/export/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "results/disk/error.hpp"
#include "results/disk/printable.hpp"
#include "results/export/extended_xyz.hpp"
#include "results/export/lammps_dump.hpp"
#include "results/export/vtk_points.hpp"

namespace jostle::inline results {
namespace {

using Taps = std::vector<std::uint64_t>;

Taps taps_with_positions(const std::vector<SnapshotRecord>& records) {
  Taps taps;
  for (const SnapshotRecord& record : records)
    if (!record.centres.empty()) taps.push_back(record.tap);
  return taps;
}

/// Alternatives for a reader: the realizations that keep positions, and their taps.
std::string all_kept(const ResultsFile& file) {
  constexpr int most_lines = 12;
  std::string text;
  int lines = 0;
  for (const RealizationSummary& realization : file.realizations()) {
    const Taps taps = taps_with_positions(file.positions(realization.id));
    if (taps.empty()) continue;
    if (++lines > most_lines) return text + "\n  ...";
    text += fmt::format("\n  sweep point {}, realization {}: taps {}", realization.id.point,
                        realization.id.realization, list_of(taps));
  }
  if (text.empty()) return "; the file keeps no positions (\"snapshots\" in a scene)";
  return "; the file keeps" + text;
}

void require(bool is_present, const ResultsFile& file, const std::string& wanted) {
  if (is_present) return;
  throw std::invalid_argument(
      fmt::format("{}: holds no positions of {}{}", file.path(), wanted, all_kept(file)));
}

std::vector<ExportedFrame> snapshots_of(const ResultsFile& file, RealizationId id) {
  const Study& study = file.study();
  const std::string name = fmt::format("sweep point {}, realization {}", id.point, id.realization);
  require(id.point < study.points.size() && id.realization < study.realizations, file, name);
  auto records = file.snapshots(id);
  std::erase_if(records, [](const SnapshotRecord& record) { return record.centres.empty(); });
  require(!records.empty(), file, name);
  const auto sizes = file.sizes(id);
  std::vector<ExportedFrame> frames;
  for (SnapshotRecord& record : records) {
    ExportedFrame& frame = frames.emplace_back();
    frame.tap = record.tap;
    frame.packing = {study.points[id.point].container, std::move(record.centres), sizes};
    if (!record.velocities.empty())
      frame.vectors.push_back(
          {"velocity", "velo", {"vx", "vy", "vz"}, std::move(record.velocities)});
    if (!record.spins.empty())
      frame.vectors.push_back(
          {"spin", "omega", {"omegax", "omegay", "omegaz"}, std::move(record.spins)});
  }
  return frames;
}

std::vector<ExportedFrame> xyz_frames(const std::string& path) {
  std::vector<ExportedFrame> frames;
  for (Packing& packing : read_extended_xyz_frames(path))
    frames.push_back({frames.size(), std::move(packing), {}});
  return frames;
}

std::vector<ExportedFrame> chosen(const std::string& path, std::vector<ExportedFrame> frames,
                                  const KeptTaps& choice) {
  if (choice.all) return frames;
  if (choice.taps.empty()) {
    frames.erase(frames.begin(), frames.end() - 1);
    return frames;
  }
  Taps kept;
  for (const ExportedFrame& frame : frames) kept.push_back(frame.tap);
  for (const std::uint64_t tap : choice.taps)
    if (std::ranges::find(kept, tap) == kept.end())
      throw std::invalid_argument(
          fmt::format("{}: holds no positions of tap {}; kept: {}", path, tap, list_of(kept)));
  std::erase_if(frames, [&](const ExportedFrame& frame) {
    return std::ranges::find(choice.taps, frame.tap) == choice.taps.end();
  });
  return frames;
}

std::vector<ExportedFrame> with_columns(const std::string& path,
                                        std::vector<ExportedFrame> frames) {
  for (ExportedFrame& frame : frames) {
    try {
      frame.columns = particle_columns(frame.packing);
    } catch (const std::invalid_argument& error) {
      throw ResultsError(path, error.what());
    }
  }
  return frames;
}

}  // namespace

const char* extension(ExportFormat format) {
  switch (format) {
    case ExportFormat::extended_xyz:
      return "xyz";
    case ExportFormat::lammps:
      return "dump";
    case ExportFormat::vtk:
      return "vtp";
    case ExportFormat::h5md:
      return "h5md";
  }
  return "";
}

std::string list_of(std::span<const std::uint64_t> taps) {
  std::string text;
  for (const std::uint64_t tap : taps)
    text.append(text.empty() ? "" : ", ").append(std::to_string(tap));
  return text;
}

std::vector<ExportedFile> exported_files(ExportFormat format, const std::string& path,
                                         std::span<const ExportedFrame> frames) {
  if (format == ExportFormat::extended_xyz) return {{path, extended_xyz_text(frames)}};
  if (format == ExportFormat::lammps) return {{path, lammps_dump_text(frames)}};
  if (frames.size() == 1) return {{path, vtk_points_text(frames.front())}};
  std::filesystem::path stem(path);
  if (stem.extension() == ".vtp" || stem.extension() == ".pvd") stem.replace_extension();
  std::vector<ExportedFile> files;
  std::vector<std::pair<std::uint64_t, std::string>> listed;
  for (const ExportedFrame& frame : frames) {
    const std::string name = fmt::format("{}_tap{}.vtp", stem.string(), frame.tap);
    listed.emplace_back(frame.tap, std::filesystem::path(name).filename().string());
    files.push_back({name, vtk_points_text(frame)});
  }
  const std::string& first = listed.front().second;
  if (printable(first) != first)
    throw ResultsError(path,
                       "has a name that XML cannot hold, in which the .pvd names the others; "
                       "choose another name");
  files.push_back({stem.string() + ".pvd", vtk_collection_text(listed)});
  return files;
}

std::vector<ExportedFrame> kept_frames(const ResultsFile& file, RealizationId id,
                                       const KeptTaps& choice) {
  return with_columns(file.path(), chosen(file.path(), snapshots_of(file, id), choice));
}

std::vector<ExportedFrame> kept_frames(const std::string& extended_xyz, const KeptTaps& choice) {
  return with_columns(extended_xyz, chosen(extended_xyz, xyz_frames(extended_xyz), choice));
}

}  // namespace jostle::inline results
