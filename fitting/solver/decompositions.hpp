#pragma once

#include <Eigen/Core>
#include <memory>

// Decompositions of matrices with few columns. Eigen's templates for them cost seconds in every
// source that uses one: they are in one source, behind plain functions.
namespace jostle::inline fitting {

/// The x that minimises |a x - b|, by Householder QR with column pivoting. a: [n, m]; b: [n].
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The solution for every column of b, [n, k]: [m, k].
Eigen::MatrixXd least_squares_of_columns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Columns that are independent to rounding, by the same decomposition.
Eigen::Index column_rank(const Eigen::MatrixXd& a);

/// a = Q R P^T by Householder reflections with column pivoting, kept for several right sides.
/// a: [n, m].
class PivotedQr {
 public:
  explicit PivotedQr(const Eigen::MatrixXd& a);
  ~PivotedQr();

  /// Columns that are independent to rounding.
  Eigen::Index rank() const;
  /// R P^T, [min(n, m), m].
  Eigen::MatrixXd triangle() const;
  /// The first min(n, m) rows of Q^T v; v: [n].
  Eigen::VectorXd rotated(const Eigen::VectorXd& v) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

struct TriangularSystem {
  Eigen::MatrixXd upper;  // R, [m, m]
  Eigen::VectorXd right;  // the first m rows of Q^T b
};
/// Reduces the least squares problem a x = b, without pivoting. a: [n, m], n >= m;
/// b: [n].
TriangularSystem triangular_system(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// R of a = Q R, [min(n, m), m], without pivoting.
Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& a);

struct OrthonormalBasis {
  Eigen::MatrixXd basis;     // Q, [n, m]
  Eigen::MatrixXd triangle;  // R, [m, m]
};
/// For a: [n, m], n >= m.
OrthonormalBasis orthonormal_basis(const Eigen::MatrixXd& a);

struct SingularValues {
  Eigen::VectorXd values;   // [m], descending
  Eigen::MatrixXd vectors;  // V, [m, m], a vector a column
};
/// For a: [m, m], by Jacobi's method.
SingularValues singular_values(const Eigen::MatrixXd& a);

struct SymmetricSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd diagonal;  // D of a = P^T L D L^T P: its product is the determinant
};
/// a x = b, a symmetric and not negative.
SymmetricSolution solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace jostle::inline fitting
