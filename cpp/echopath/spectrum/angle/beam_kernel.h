#pragma once
// Forms many beams over many snapshots: a complex matrix product whose squares are added up, in plain loops.
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "echopath/base/threads/job.h"

namespace echopath {

enum class Combine { kSum, kPeak };  // sum or largest of the powers of several snapshots

// Forms beams that receive plane waves: steering^H times a vector over the elements.
class BeamKernel {
 public:
  static constexpr int64_t kColumns = 32;  // handled together
  using Powers = std::vector<double>;      // [directions, kColumns]

  explicit BeamKernel(const Eigen::MatrixXcd& steering);  // [elements, directions]
  int64_t num_directions() const { return steering_.cols(); }
  int64_t num_elements() const { return steering_.rows(); }

  // Combines power with |steering^H columns|^2 of each of at most kColumns columns [elements].
  void add_squares(const Eigen::Ref<const Eigen::MatrixXcd>& columns, Combine combine, Powers& power) const;

  // Returns |steering^H column|^2 [directions], combined over all columns. Raises Cancelled.
  Eigen::VectorXd power(const Eigen::MatrixXcd& columns, Combine combine = Combine::kSum, const Job* job = nullptr) const;

 private:
  Eigen::MatrixXcd steering_;
  int64_t padded_;               // elements, rounded up to a multiple of those added per pass
  std::vector<double> re_, im_;  // [directions, padded] of steering^H
};

}  // namespace echopath
