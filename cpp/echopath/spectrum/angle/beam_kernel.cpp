#include "echopath/spectrum/angle/beam_kernel.h"

#include <algorithm>

#include "echopath/base/lanes/simd.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int kColumns = BeamKernel::kColumns;
constexpr int kElements = 4;    // added per pass over the columns
constexpr int kFewColumns = 4;  // fewer do not fill a block
// Counts the directions whose steering vectors are there at a time besides those that are kept.
constexpr int64_t kDirectionsAtATime = 256;

// Adds four elements, each times its weight, to `out`.
ECHOPATH_INLINE void add_elements(const double* weight_re, const double* weight_im, const double* re, const double* im,
                                  double* out_re, double* out_im) {
  const double a0 = weight_re[0], a1 = weight_re[1], a2 = weight_re[2], a3 = weight_re[3];
  const double b0 = weight_im[0], b1 = weight_im[1], b2 = weight_im[2], b3 = weight_im[3];
  const double *re1 = re + kColumns, *re2 = re1 + kColumns, *re3 = re2 + kColumns;
  const double *im1 = im + kColumns, *im2 = im1 + kColumns, *im3 = im2 + kColumns;
  for (int c = 0; c < kColumns; ++c) {
    out_re[c] +=
        (a0 * re[c] - b0 * im[c]) + (a1 * re1[c] - b1 * im1[c]) + (a2 * re2[c] - b2 * im2[c]) + (a3 * re3[c] - b3 * im3[c]);
    out_im[c] +=
        (a0 * im[c] + b0 * re[c]) + (a1 * im1[c] + b1 * re1[c]) + (a2 * im2[c] + b2 * re2[c]) + (a3 * im3[c] + b3 * re3[c]);
  }
}

// Holds real and imaginary parts of complex numbers.
struct SplitComplex {
  const double *re, *im;
};

// weights [directions, padded], columns [padded, kColumns]
ECHOPATH_INLINE void add_squares_of_block(int64_t directions, int64_t padded, SplitComplex weights, SplitComplex columns,
                                          Combine combine, double* power) {
  for (int64_t d = 0; d < directions; ++d) {
    alignas(64) double out_re[kColumns] = {}, out_im[kColumns] = {};
    for (int64_t e = 0; e < padded; e += kElements) {
      const double *row_re = weights.re + d * padded + e, *row_im = weights.im + d * padded + e;
      add_elements(row_re, row_im, columns.re + e * kColumns, columns.im + e * kColumns, out_re, out_im);
    }
    double* total = power + d * kColumns;
    for (int c = 0; c < kColumns; ++c) {
      const double square = out_re[c] * out_re[c] + out_im[c] * out_im[c];
      total[c] = combine == Combine::kSum ? total[c] + square : std::max(total[c], square);
    }
  }
}

}  // namespace

BeamKernel::BeamKernel(const VirtualArray& array, const std::vector<Vec3>& directions)
    : num_elements_(std::ssize(array.elements)), num_directions_(std::ssize(directions)),
      padded_((num_elements_ + kElements - 1) / kElements * kElements), re_(num_directions_ * padded_),
      im_(num_directions_ * padded_) {
  const auto set = [&](int64_t begin, int64_t end) {
    set_rows(begin, steering_vectors(array, {directions.begin() + begin, directions.begin() + end}));
  };
  if (num_directions_ > kDirectionsAtATime) parallel_for_chunks(num_directions_, kDirectionsAtATime, set);
  else set(0, num_directions_);
}

void BeamKernel::set_rows(int64_t first, const Eigen::MatrixXcd& steering) {
  for (int64_t d = 0; d < steering.cols(); ++d) {
    const int64_t row = (first + d) * padded_;
    for (int64_t e = 0; e < num_elements_; ++e) {
      re_[row + e] = steering(e, d).real();
      im_[row + e] = -steering(e, d).imag();
    }
  }
}

void BeamKernel::add_squares(const Eigen::Ref<const Eigen::MatrixXcd>& columns, Combine combine,
                             std::vector<double>& power) const {
  std::vector<double> re(padded_ * kColumns), im(padded_ * kColumns);
  for (int64_t c = 0; c < columns.cols(); ++c) {
    for (int64_t e = 0; e < num_elements(); ++e) {
      re[e * kColumns + c] = columns(e, c).real();
      im[e * kColumns + c] = columns(e, c).imag();
    }
  }
  run_simd<add_squares_of_block>(num_directions(), padded_, SplitComplex{re_.data(), im_.data()},
                                 SplitComplex{re.data(), im.data()}, combine, power.data());
}

Eigen::MatrixXd BeamKernel::squares_of_few(const Eigen::MatrixXcd& columns) const {
  const Eigen::MatrixXd re = columns.real(), im = columns.imag();
  const auto weights_re = rows(re_).leftCols(num_elements_), weights_im = rows(im_).leftCols(num_elements_);
  Eigen::MatrixXd out_re = weights_re * re, out_im = weights_re * im;
  out_re.noalias() -= weights_im * im;
  out_im.noalias() += weights_im * re;
  return out_re.cwiseAbs2() + out_im.cwiseAbs2();
}

Eigen::VectorXd BeamKernel::power(const Eigen::MatrixXcd& columns, Combine combine, const Job* job) const {
  const bool is_sum = combine == Combine::kSum;
  if (columns.cols() < kFewColumns) {
    const Eigen::MatrixXd squares = squares_of_few(columns);
    return is_sum ? Eigen::VectorXd(squares.rowwise().sum()) : Eigen::VectorXd(squares.rowwise().maxCoeff());
  }
  std::vector<double> squares(num_directions() * kColumns);
  for (int64_t first = 0; first < columns.cols(); first += kColumns) {
    if (job) job->throw_if_cancelled();
    const int64_t count = std::min<int64_t>(kColumns, columns.cols() - first);
    add_squares(columns.middleCols(first, count), combine, squares);
  }
  const Eigen::Map<const Eigen::MatrixXd> by_column(squares.data(), kColumns, num_directions());
  return is_sum ? Eigen::VectorXd(by_column.colwise().sum()) : Eigen::VectorXd(by_column.colwise().maxCoeff());
}

}  // namespace echopath
