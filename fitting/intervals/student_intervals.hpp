#pragma once

#include "fitting/fit.hpp"
#include "fitting/intervals/dependence.hpp"

// Student's t intervals, for realizations whose curves differ in shape.
namespace jostle::inline fitting {

/// Returns true if realizations scatter in other directions than a profile explores. A profile
/// moves all parameters along the direction that least squares constrain least. Where realizations
/// differ in shape, the end of one profile can require a value of another parameter that the
/// scatter of this parameter excludes. The test compares, for each pair of variables, the squared
/// step of the second variable at the end of the first one's interval with the square of its own
/// half-width; with independent noise the ratio is at most Fisher's F of (dof, dof), and 1 % is the
/// level per pair. False without realizations.
bool realizations_differ_in_shape(const DependentErrors& errors, const Fit& fit);

/// Replaces the intervals of an estimate by value +- t times the clustered standard error in the
/// variable of the fit (the logarithm of a positive parameter). Keeps profiled intervals whose
/// 95 % ends agree with these within a quarter of the distance to the value. An end that is farther
/// than a profile searches is open.
void use_student_intervals(const Curve& curve, double dof, Estimate& estimate);

}  // namespace jostle::inline fitting
