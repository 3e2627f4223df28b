#include "echopath/spectrum/cfar_factor/drawn_powers.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"

namespace echopath {
namespace {

constexpr uint64_t kSeed = 1;

double mean_of(const CellPowers& powers, const CellGroup& cells) {
  return sum_of(powers, cells) / static_cast<double>(cells.size());
}

}  // namespace

TiltedNoise::TiltedNoise(const Eigen::MatrixXd& form, double tilt, int num_channels)
    : root(Eigen::LLT<Eigen::MatrixXd>(Eigen::MatrixXd::Identity(form.rows(), form.rows()) + tilt * form)),
      log_mean(-2.0 * num_channels * root.matrixLLT().diagonal().array().log().sum()) {}

DrawnPowers::DrawnPowers(const CfarDesign& design, const TrainingNoise& noise)
    : design_(design), noise_(noise), training_(training_cells(design.cells)),
      halves_(halves_of_training_cells(design.cells)) {}

// The columns are the real and imaginary parts of every channel.
Eigen::MatrixXd DrawnPowers::white_numbers(int64_t index, Eigen::Index count) const {
  Eigen::MatrixXd numbers(count, 2 * design_.noise.num_channels);
  for (Eigen::Index c = 0; c < numbers.cols(); c += 2) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto [u, v] =
          uniform2(kSeed, Stream::kTraining, static_cast<uint64_t>(index), static_cast<uint32_t>(c / 2 * count + i));
      const double radius = std::sqrt(-std::log1p(-u));  // parts of variance 1/2
      numbers(i, c) = radius * std::cos(kTwoPi * v);
      numbers(i, c + 1) = radius * std::sin(kTwoPi * v);
    }
  }
  return numbers;
}

CellPowers DrawnPowers::draw(int64_t index, const TiltedNoise& tilted) const {
  Eigen::MatrixXd numbers = white_numbers(index, tilted.root.rows());
  tilted.root.matrixU().solveInPlace(numbers);
  const Eigen::MatrixXd &left = noise_.velocity_factor(), &right = noise_.range_factor();
  CellPowers powers = CellPowers::Zero(left.rows(), right.rows());
  for (Eigen::Index c = 0; c < numbers.cols(); ++c) {
    const Eigen::Map<const CellPowers> field(numbers.col(c).data(), left.cols(), right.cols());
    powers += (left * field * right.transpose()).cwiseAbs2();
  }
  return powers;
}

double DrawnPowers::statistic(const CellPowers& powers) const {
  if (design_.method != CfarMethod::kOrderedStatistic) {
    const double means[] = {mean_of(powers, halves_[0]), mean_of(powers, halves_[1])};
    return design_.method == CfarMethod::kGreatestOf ? std::ranges::max(means) : std::ranges::min(means);
  }
  std::vector<double> training;
  for (const int cell : training_) training.push_back(powers.data()[cell]);
  const auto place = training.begin() + (design_.order() - 1);
  std::ranges::nth_element(training, place);
  return *place;
}

double sum_of(const CellPowers& powers, const CellGroup& cells) {
  double sum = 0.0;
  for (const int cell : cells) sum += powers.data()[cell];
  return sum;
}

}  // namespace echopath
