#pragma once

#include <Eigen/Core>

// Decompositions of matrices with few columns. Eigen's templates for them take seconds of every
// source that uses one: they stand in one, behind plain functions.
namespace jostle::inline fitting {

/// The x that minimises |a x - b|, by Householder QR with column pivoting. a: [n, m]; b: [n].
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The same for every column of b, [n, k]: [m, k].
Eigen::MatrixXd least_squares_of_columns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Columns that are independent to rounding, by the same decomposition.
Eigen::Index column_rank(const Eigen::MatrixXd& a);

/// R of a = Q R, [min(n, m), m], without pivoting.
Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& a);

struct OrthonormalBasis {
  Eigen::MatrixXd basis;     // Q, [n, m]
  Eigen::MatrixXd triangle;  // R, [m, m]
};
/// Of a: [n, m], n >= m.
OrthonormalBasis orthonormal_basis(const Eigen::MatrixXd& a);

struct SingularValues {
  Eigen::VectorXd values;   // [m], descending
  Eigen::MatrixXd vectors;  // V, [m, m], a vector a column
};
/// Of a: [m, m], by Jacobi's method.
SingularValues singular_values(const Eigen::MatrixXd& a);

struct SymmetricSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd diagonal;  // D of a = P^T L D L^T P: its product is the determinant
};
/// a x = b, a symmetric and not negative.
SymmetricSolution solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace jostle::inline fitting
