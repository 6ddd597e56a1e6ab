#pragma once

namespace jostle::inline fitting {

/// ln Gamma(x) for x > 0. std::lgamma writes to a global, and fits run on many threads.
double log_gamma(double x);
/// Quantile `level` in (0, 1) of |z| for a standard normal variable.
double normal_two_sided(double level);
/// Quantile for Student's t with dof > 0 degrees of freedom. Its square is the quantile of
/// F(1, dof), as the square of the former is that of chi2 with one degree of freedom.
double student_two_sided(double level, double dof);
/// Student's t, or the normal where dof is infinite.
double two_sided(double level, double dof);
/// Probability that |z| of a standard normal variable exceeds |z|.
double normal_tails(double z);
/// Probability that Student's |t| exceeds |t|.
double student_tails(double t, double dof);
/// Probability that Fisher's F of dof_1 and dof_2 > 0 degrees of freedom exceeds f >= 0.
double fisher_tail(double f, double dof_1, double dof_2);
/// Probability that chi2 with dof > 0 degrees of freedom exceeds x >= 0.
double chi_squared_tail(double x, double dof);

/// The probabilities of the two intervals: that of one standard error, and 95 %.
inline constexpr double interval_levels[] = {0.682689492137086, 0.95};

/// Half the width of the interval that holds the truth with probability `level`, of an estimate
/// with this standard error and Student's t of dof degrees of freedom (the normal distribution
/// where dof is infinite). Every a(b), bar and band that a person reads is this, at 68 %. NaN
/// without degrees of freedom.
double half_width(double error, double dof, double level = interval_levels[0]);

}  // namespace jostle::inline fitting
