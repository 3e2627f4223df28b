#include "echopath/label/cells/cell_errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kCellsPerErrorTask = 1 << 11;
constexpr double kStandardErrorsOfLead = 2.0;

void check_batches(const std::vector<BatchPowers>& parts, int num_batches, size_t num_cells) {
  require(!parts.empty(), "parts", "must be one or more", "none");
  require(num_batches >= 2, "num_batches", "must be at least 2", num_batches);
  const size_t size = num_cells * static_cast<size_t>(num_batches);
  for (const BatchPowers& part : parts) {
    for (const std::span<const double> values : {part.cross, part.coherent, part.diffuse}) {
      require(values.size() == size, "parts", "must have batches x cells values, " + std::to_string(size), values.size());
    }
  }
}

double sum_of_squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

// Holds one part in one cell.
struct PartInCell {
  double power = 0.0;             // W
  double noise = 0.0;             // W^2, variance of the power by noise of second order
  std::vector<double> influence;  // [B] W, of each batch
};

// Reads the values of one cell from `values` [B, N].
struct Column {
  std::span<const double> values;
  int64_t cell, num_cells;
  double operator[](int batch) const { return values[batch * num_cells + cell]; }
};

PartInCell part_in_cell(const BatchPowers& part, int num_batches, int64_t cell, int64_t num_cells) {
  const double count = num_batches, pairs = count * (count - 1.0);
  const auto column = [&](std::span<const double> values) { return Column{values, cell, num_cells}; };
  const Column cross = column(part.cross), coherent = column(part.coherent), diffuse = column(part.diffuse);
  double mean_square = 0.0, squares = 0.0, mean_diffuse = 0.0;
  for (int b = 0; b < num_batches; ++b) {
    mean_square += cross[b] / count;
    squares += coherent[b];
    mean_diffuse += diffuse[b] / count;
  }
  const double coherent_power = (count * count * mean_square - squares) / pairs;
  const double variance = std::max(squares - count * mean_square, 0.0) / (count - 1.0);
  const double factor = coherent_power > 0.0 ? 2.0 * std::sqrt(coherent_power / mean_square) : 0.0;
  PartInCell made{std::max(coherent_power + mean_diffuse, 0.0), variance * variance / pairs, {}};
  for (int b = 0; b < num_batches; ++b) {
    made.influence.push_back(factor * (cross[b] - mean_square) + diffuse[b] - mean_diffuse);
  }
  return made;
}

// Holds all parts in one cell.
class Cell {
 public:
  Cell(const std::vector<BatchPowers>& parts, int num_batches, int64_t cell, int64_t num_cells)
      : num_batches_(num_batches), pairs_(num_batches * (num_batches - 1.0)) {
    for (const BatchPowers& part : parts) {
      parts_.push_back(part_in_cell(part, num_batches, cell, num_cells));
      total_ += parts_.back().power;
      total_noise_ += parts_.back().noise;
    }
    if (!is_dark()) set_share_influence();
  }

  bool is_dark() const { return total_ == 0.0; }
  double power(size_t part) const { return parts_[part].power; }
  double power_error(size_t part) const {
    return std::sqrt(sum_of_squares(parts_[part].influence) / pairs_ + parts_[part].noise);
  }
  double share(size_t part) const { return parts_[part].power / total_; }
  // Returns the standard error of share(plus) - share(minus), or of share(plus) where there is no part `minus`.
  double error_of_difference(size_t plus, size_t minus) const {
    const bool is_difference = minus < parts_.size();
    std::vector<double> influence = share_influence_[plus];
    for (size_t b = 0; is_difference && b < influence.size(); ++b) influence[b] -= share_influence_[minus][b];
    const double value = share(plus) - (is_difference ? share(minus) : 0.0);
    double noise = value * value * total_noise_ + (1.0 - 2.0 * value) * parts_[plus].noise;
    if (is_difference) noise += (1.0 + 2.0 * value) * parts_[minus].noise;
    return std::sqrt(sum_of_squares(influence) / pairs_ + noise / (total_ * total_));
  }
  bool leads(size_t part) const {
    for (size_t other = 0; other < parts_.size(); ++other) {
      if (other == part) continue;
      const double lead = share(part) - share(other);
      if (lead <= 0.0 || lead < kStandardErrorsOfLead * error_of_difference(part, other)) return false;
    }
    return true;
  }

 private:
  // Computes the influence of each batch from the shares without it.
  void set_share_influence() {
    share_influence_.assign(parts_.size(), std::vector<double>(static_cast<size_t>(num_batches_)));
    for (size_t b = 0; b < static_cast<size_t>(num_batches_); ++b) {
      double total = 0.0;
      for (size_t k = 0; k < parts_.size(); ++k) total += power_without(k, b);
      for (size_t k = 0; k < parts_.size(); ++k) share_influence_[k][b] = total > 0.0 ? power_without(k, b) / total : 0.0;
    }
    for (std::vector<double>& shares : share_influence_) {
      const double mean = std::accumulate(shares.begin(), shares.end(), 0.0) / num_batches_;
      for (double& value : shares) value = (num_batches_ - 1.0) * (mean - value);
    }
  }
  double power_without(size_t part, size_t batch) const {
    return std::max(parts_[part].power - parts_[part].influence[batch] / (num_batches_ - 1.0), 0.0);
  }

  int num_batches_;
  double pairs_, total_ = 0.0, total_noise_ = 0.0;
  std::vector<PartInCell> parts_;
  std::vector<std::vector<double>> share_influence_;  // [K][B]
};

}  // namespace

ShareErrors share_errors(const std::vector<BatchPowers>& parts, int num_batches, std::span<const int16_t> dominant,
                         Job* job) {
  const size_t num_cells = dominant.size(), size = parts.size() * num_cells;
  check_batches(parts, num_batches, num_cells);
  ShareErrors errors{std::vector<double>(size), std::vector<double>(size), std::vector<double>(size),
                     std::vector<double>(size), std::vector<uint8_t>(num_cells)};
  const auto label = [&](size_t i) {
    const Cell cell(parts, num_batches, static_cast<int64_t>(i), static_cast<int64_t>(num_cells));
    for (size_t k = 0; k < parts.size(); ++k) {
      errors.power[k * num_cells + i] = cell.power(k);
      errors.power_error[k * num_cells + i] = cell.power_error(k);
      if (cell.is_dark()) continue;
      errors.share[k * num_cells + i] = cell.share(k);
      errors.share_error[k * num_cells + i] = cell.error_of_difference(k, parts.size());
    }
    errors.certain[i] = dominant[i] >= 0 && !cell.is_dark() && cell.leads(static_cast<size_t>(dominant[i]));
  };
  parallel_for_chunks(std::ssize(dominant), kCellsPerErrorTask, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) label(i);
  }, job);
  return errors;
}

}  // namespace echopath
