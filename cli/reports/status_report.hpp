#pragma once

#include <string>
#include <vector>

#include "config/json/json.hpp"
#include "study/planning/shards.hpp"

namespace jostle::inline cli {

/// How the jobs of a study run: data from their batch script.
struct JobArray {
  std::string script;  // its file; empty where there is none
  std::uint32_t shards_a_task = 1;
};

/// The batch script that jobs have put beside their results, if it is one for so many shards.
JobArray job_array(const ShardsStatus& study);

/// The commands that redo what is neither done, running nor unreadable, and nothing else: one for a
/// job array, else one a shard; or what to do with what is done. Empty where nothing is to be done.
std::vector<std::string> redo_commands(const ShardsStatus& study, const JobArray& array);

/// One shard a line, with what it is at; ends in a newline.
std::string status_text(const ShardsStatus& study);
Json status_json(const ShardsStatus& study, const std::vector<std::string>& redo);

}  // namespace jostle::inline cli
