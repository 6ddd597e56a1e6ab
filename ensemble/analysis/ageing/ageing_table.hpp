#pragma once

#include <string>

#include "ensemble/analysis/ageing/ageing.hpp"
#include "ensemble/analysis/table.hpp"
#include "structure/observables.hpp"

namespace jostle::inline ensemble {

/// The whole ageing analysis of one observable: A(t, t_W), V and C with errors, fits of eq. 6 with
/// and without a common B, the collapse of A / A_inf against t / tau, tau and A_inf against t_W, A
/// and V as one function of lag and age. `rows` holds taps_of(grid), as far as the series goes;
/// `name` is that of the table
/// ("point_0000/ageing/mean_height").
Table ageing_table(std::string name, const Column& observable, const TapRows& rows,
                   const AgeingGrid& grid, int threads = 1);

}  // namespace jostle::inline ensemble
