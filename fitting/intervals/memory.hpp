#pragma once

#include <Eigen/Core>
#include <vector>

// How long the residuals of a single curve remember: neighbouring points of one realization are not
// independent, and a fit hides part of that in its parameters.
namespace jostle::inline fitting {

/// Noise with a memory: a share that forgets exponentially and white noise beside it, correlation
/// share exp(-|t - t'| / time) between different points.
struct Memory {
  double time = 0;            // in units of t; 0 where the points are independent
  double share = 0;           // share of the variance that has a memory
  double variance = 0;        // variance of a residual
  double effective_size = 0;  // independent points whose mean would be known as well
};

/// By restricted maximum likelihood (Patterson & Thompson 1971, doi:10.1093/biomet/58.3.545), which
/// allows for what the parameters have taken up. Independence is kept unless twice the gain of the
/// likelihood by a memory is above 10, which chance gives to fewer than 1 of 100 curves of white
/// noise: a memory that is not there opens intervals of short curves; one that is overlooked makes
/// them too short. t: [n], ascending; residuals: [n]; basis: [n, n_variables], orthonormal columns
/// that span those of the Jacobian; n > n_variables.
Memory residual_memory(const std::vector<double>& t, const Eigen::VectorXd& residuals,
                       const Eigen::MatrixXd& basis);

/// The correlation matrix of such noise times the columns of `vectors` [n, any].
Eigen::MatrixXd correlated(const std::vector<double>& t, const Memory& memory,
                           const Eigen::MatrixXd& vectors);

}  // namespace jostle::inline fitting
