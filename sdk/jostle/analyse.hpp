#pragma once

// Fits and analyses of results and of measured curves: the tables of `jostle fit` and `jostle
// analyse`.

#include "ensemble/analysis/ageing/ageing_table.hpp"
#include "ensemble/analysis/ageing/collapse.hpp"
#include "ensemble/analysis/ageing/fits.hpp"
#include "ensemble/analysis/hysteresis.hpp"
#include "ensemble/analysis/memory/memory.hpp"
#include "ensemble/analysis/ordering/ordering_table.hpp"
#include "ensemble/analysis/steady_state.hpp"
#include "ensemble/analysis/volumes/volume_table.hpp"
#include "study/tables/analyse.hpp"
#include "study/tables/fits.hpp"
#include "study/tables/laws/own_law.hpp"
#include "study/tables/measured/curve_file.hpp"
#include "study/tables/motion.hpp"
#include "study/tables/points/half_widths.hpp"
#include "study/tables/points/sweep.hpp"
