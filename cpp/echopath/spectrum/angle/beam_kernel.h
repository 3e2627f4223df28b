#pragma once
// Forms many beams over many snapshots: a complex matrix product whose squares are added up, in plain loops.
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/spectrum/array/steering.h"

namespace echopath {

enum class Combine { kSum, kPeak };  // sum or largest of the powers of several snapshots

// Forms beams that receive plane waves: steering^H times a vector over the elements.
class BeamKernel {
 public:
  static constexpr int64_t kColumns = 32;  // handled together
  using Powers = std::vector<double>;      // [directions, kColumns]

  // Holds 16 bytes for each element of the array and direction.
  BeamKernel(const VirtualArray& array, const std::vector<Vec3>& directions);
  int64_t num_directions() const { return num_directions_; }
  int64_t num_elements() const { return num_elements_; }

  // Combines power with |steering^H columns|^2 of each of at most kColumns columns [elements].
  void add_squares(const Eigen::Ref<const Eigen::MatrixXcd>& columns, Combine combine, Powers& power) const;

  // Returns |steering^H column|^2 [directions], combined over all columns. Raises Cancelled.
  Eigen::VectorXd power(const Eigen::MatrixXcd& columns, Combine combine = Combine::kSum, const Job* job = nullptr) const;

 private:
  using Rows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

  void set_rows(int64_t first, const Eigen::MatrixXcd& steering);  // of the directions from `first` on
  Rows rows(const std::vector<double>& part) const { return {part.data(), num_directions_, padded_}; }
  Eigen::MatrixXd squares_of_few(const Eigen::MatrixXcd& columns) const;  // [directions, columns]

  int64_t num_elements_, num_directions_;
  int64_t padded_;               // elements, rounded up to a multiple of those added per pass
  std::vector<double> re_, im_;  // [directions, padded] of steering^H
};

}  // namespace echopath
