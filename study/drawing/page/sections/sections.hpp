#pragma once

#include "study/drawing/page/sections/blocks.hpp"

namespace jostle::inline study {

struct PageParts {
  bool has_grains = false, has_packings = false;
};

/// The sections of a page below what was run, in their order.
Json page_sections(const DrawnFile& file, const std::vector<Figure>& figures,
                   const PageParts& parts);

/// A summary of the file in five lines; `run` is the first. `path` names the file in
/// commands.
Json summary_section(const DrawnFile& file, const std::string& run, const std::string& path);

// Each null where the file has nothing for it.
Json fits_section(const PageContent& content);
Json steady_section(const PageContent& content);
Json ageing_section(const PageContent& content);
Json spectra_section(const PageContent& content);
Json hysteresis_section(const PageContent& content);
Json sweep_section(const PageContent& content);
Json ordering_section(const PageContent& content);
Json motion_section(const PageContent& content);
Json volumes_section(const PageContent& content);
Json memory_section(const PageContent& content);
Json snapshots_section(const PageContent& content);
std::vector<Json> structure_sections(const PageContent& content);
Json cost_section(const PageContent& content);
Json precision_section(const PageContent& content);

}  // namespace jostle::inline study
