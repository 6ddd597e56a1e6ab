#pragma once

// Results files: series, packings, tables and provenance, and export to formats of other programs.

#include "results/disk/error.hpp"
#include "results/export/export.hpp"
#include "results/export/extended_xyz.hpp"
#include "results/export/packing_file.hpp"
#include "results/file/tables.hpp"
#include "study/provenance.hpp"
#include "study/results_input.hpp"
