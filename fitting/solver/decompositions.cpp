#include "fitting/solver/decompositions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace jostle::inline fitting {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

Eigen::MatrixXd least_squares_of_columns(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

Eigen::Index column_rank(const Eigen::MatrixXd& a) {
  return a.colPivHouseholderQr().rank();
}

struct PivotedQr::Impl {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  Eigen::Index n_rows() const { return std::min(qr.rows(), qr.cols()); }
};

PivotedQr::PivotedQr(const Eigen::MatrixXd& a)
    : impl_(new Impl{Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(a)}) {}
PivotedQr::~PivotedQr() = default;

Eigen::Index PivotedQr::rank() const {
  return impl_->qr.rank();
}

Eigen::MatrixXd PivotedQr::triangle() const {
  const Eigen::MatrixXd upper =
      impl_->qr.matrixQR().topRows(impl_->n_rows()).triangularView<Eigen::Upper>();
  return upper * impl_->qr.colsPermutation().transpose();
}

Eigen::VectorXd PivotedQr::rotated(const Eigen::VectorXd& v) const {
  Eigen::VectorXd rotated = v;
  rotated.applyOnTheLeft(impl_->qr.householderQ().adjoint());
  return rotated.head(impl_->n_rows());
}

TriangularSystem triangular_system(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  Eigen::VectorXd rotated = b;
  rotated.applyOnTheLeft(qr.householderQ().adjoint());
  return {qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>(), rotated.head(a.cols())};
}

Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  const Eigen::Index rows = std::min(a.rows(), a.cols());
  return qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
}

OrthonormalBasis orthonormal_basis(const Eigen::MatrixXd& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  return {qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), a.cols()),
          qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>()};
}

SingularValues singular_values(const Eigen::MatrixXd& a) {
  // Square: there is nothing to precondition.
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(a, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

SymmetricSolution solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::LDLT<Eigen::MatrixXd> solver(a);
  return {solver.solve(b), solver.vectorD()};
}

}  // namespace jostle::inline fitting
