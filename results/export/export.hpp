#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ensemble/sink.hpp"
#include "results/export/particle_columns.hpp"
#include "results/file/results_file.hpp"

// Packings for OVITO, ParaView and other programs.
namespace jostle::inline results {

enum class ExportFormat { extended_xyz, lammps, vtk, h5md };

/// "xyz", "dump", "vtp" or "h5md": what a file of the format is named by default.
const char* extension(ExportFormat format);

struct ExportedFile {
  std::string path, text;
};

/// For a format that is text, as all but H5MD are (write_h5md):
/// what the frames are written to: `path`, with all of them; only VTK's format keeps a frame a
/// file, so that several go to STEM_tapT.vtp beside `path`, which becomes STEM.pvd, their list.
/// Requires a frame.
std::vector<ExportedFile> exported_files(ExportFormat format, const std::string& path,
                                         std::span<const ExportedFrame> frames);

/// Selection of kept packings: all, those of some taps (frames of an extended XYZ file, from 0), or
/// the last if none is named.
struct KeptTaps {
  bool all = false;
  std::vector<std::uint64_t> taps{};
};

/// "0, 10, 100".
std::string list_of(std::span<const std::uint64_t> taps);

/// The chosen packings of one realization of a results file, or of an extended XYZ file, in the
/// order of the file and with the columns of particle_columns. Throws std::invalid_argument,
/// listing what there is, where one is missing; ResultsError for the file.
std::vector<ExportedFrame> kept_frames(const ResultsFile& file, RealizationId id,
                                       const KeptTaps& choice);
std::vector<ExportedFrame> kept_frames(const std::string& extended_xyz, const KeptTaps& choice);

}  // namespace jostle::inline results
