#include "echopath/label/objects/visibility_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/even_steps.h"

namespace echopath {
namespace {

constexpr int kCells = VisibilityGrid::kSide * VisibilityGrid::kSide;  // of a block; as many as a packet has lanes
static_assert(kCells == kPacketSize);

double fraction(double value) { return value - std::floor(value); }

}  // namespace

VisibilityGrid::VisibilityGrid(const Stratum& stratum, int64_t num_cells) : directions_({stratum}) {
  const LaunchDomain domain = domain_of(stratum);
  is_disc_ = domain.is_disc();
  half_ = is_disc_ ? Eigen::Vector2d(1.0, 1.0) : domain.half;
  const double num_blocks = std::max(1.0, static_cast<double>(num_cells) / kCells);
  num_columns_ = static_cast<int>(std::clamp(std::round(std::sqrt(num_blocks * half_[0] / half_[1])), 1.0, num_blocks));
  num_rows_ = static_cast<int>(std::max(1.0, std::round(num_blocks / num_columns_)));
  const double square = is_disc_ ? 4.0 / kPi : 1.0;  // of the disc's own area
  cell_angle_ = stratum.solid_angle() * square / static_cast<double>(kCells * this->num_blocks());
  while (step_ > 1 && num_first_rows() * num_first_columns() < kFewestFirst) step_ /= 2;
  const auto size = static_cast<size_t>(this->num_blocks());
  first_met_.assign(num_first_rows() * num_first_columns(), kNothing);
  state_.assign(size, State::kUnseen);
  met_.resize(size * kCells);
}

// Sets the place in the domain of the direction of a square, `size` cells on a side; rows and columns are those of squares.
void VisibilityGrid::direct(int64_t row, int64_t column, int size, int lane, LaneValues& x, LaneValues& y) const {
  const auto r = static_cast<double>(row), c = static_cast<double>(column);
  const double along = size * (c + fraction(kEvenStep * r + 0.5)), across = size * (r + fraction(kOtherEvenStep * c + 0.5));
  x[lane] = half_[0] * (2.0 * along / (kSide * num_columns_) - 1.0);
  y[lane] = half_[1] * (2.0 * across / (kSide * num_rows_) - 1.0);
}

// Places outside of a disc meet nothing.
void VisibilityGrid::look_at(const LaneValues& x, const LaneValues& y, int count, const FindMet& find_met,
                             uint32_t* met) const {
  LaneVectors directions;
  directions_.launch(0, x, y, {0, kPacketSize}, directions);
  find_met(directions, count, met);
  for (int lane = 0; is_disc_ && lane < count; ++lane) {
    if (x[lane] * x[lane] + y[lane] * y[lane] > 1.0) met[lane] = kNothing;
  }
}

// Looks at squares of them: nearly parallel rays are faster.
double VisibilityGrid::start(const FindMet& find_met) {
  const int64_t rows = num_first_rows(), columns = num_first_columns();
  for (int64_t row = 0; row < rows; row += kSide) {
    for (int64_t column = 0; column < columns; column += kSide) {
      const int64_t width = std::min<int64_t>(kSide, columns - column);
      const auto count = static_cast<int>(width * std::min<int64_t>(kSide, rows - row));
      LaneValues x, y;
      for (int lane = 0; lane < kPacketSize; ++lane) {
        const int64_t at = std::min(lane, count - 1);
        direct(row + at / width, column + at % width, step_, lane, x, y);
      }
      std::array<uint32_t, kPacketSize> met;
      look_at(x, y, count, find_met, met.data());
      for (int64_t lane = 0; lane < count; ++lane) {
        const int64_t first = (row + lane / width) * columns + column + lane % width;
        first_met_[first] = met[lane];
      }
    }
  }
  const auto num_found = std::ssize(first_met_) - std::ranges::count(first_met_, kNothing);
  return static_cast<double>(num_found) / static_cast<double>(first_met_.size());
}

std::optional<uint32_t> VisibilityGrid::only_met(int64_t least) const {
  uint32_t only = kNothing;
  int64_t count = 0;
  for (const uint32_t met : first_met_) {
    if (met == kNothing) continue;
    if (++count > 1 && met != only) return std::nullopt;
    only = met;
  }
  return count > 0 && count >= least ? std::optional<uint32_t>(only) : std::nullopt;
}

void VisibilityGrid::finish(const FindMet& find_met) {
  if (step_ == 1) return;  // the first directions were all
  queue_changes();
  while (!queue_.empty()) {
    const int64_t block = queue_.back();
    queue_.pop_back();
    see(block, find_met);
    queue_neighbours(block);
  }
}

void VisibilityGrid::finish_everywhere(const FindMet& find_met) {
  for (int64_t block = 0; block < num_blocks(); ++block) see(block, find_met);
}

void VisibilityGrid::see(int64_t block, const FindMet& find_met) {
  if (state_[block] == State::kSeen) return;
  LaneValues x, y;
  const int64_t row = block / num_columns_ * kSide, column = block % num_columns_ * kSide;
  for (int cell = 0; cell < kCells; ++cell) direct(row + cell / kSide, column + cell % kSide, 1, cell, x, y);
  look_at(x, y, kCells, find_met, met_.data() + block * kCells);
  state_[block] = State::kSeen;
}

void VisibilityGrid::queue(int64_t block) {
  State& state = state_[block];
  if (state != State::kUnseen) return;
  state = State::kQueued;
  queue_.push_back(block);
}

// Queues the block of one of two neighbours among the first directions that met different things: where the change is in the
// block of the other one, the cells at their border lead there. Around the domain nothing is met.
void VisibilityGrid::queue_changes() {
  const int64_t rows = num_first_rows(), columns = num_first_columns(), of_block = kSide / step_;
  for (int64_t row = 0; row < rows; ++row) {
    for (int64_t column = 0; column < columns; ++column) {
      const uint32_t* const met = &first_met_[row * columns + column];
      const bool has_right = column + 1 < columns, has_below = row + 1 < rows;
      const bool is_at_rim = row == 0 || column == 0 || !has_right || !has_below;
      const bool differs = (has_right && met[0] != met[1]) || (has_below && met[0] != met[columns]);
      if (differs || (is_at_rim && *met != kNothing)) queue(row / of_block * num_columns_ + column / of_block);
    }
  }
}

// Queues the neighbours of a block that was seen where cells at their border met something else than their first directions
// did.
void VisibilityGrid::queue_neighbours(int64_t block) {
  const uint32_t* const cells = met_.data() + block * kCells;
  const int64_t row = block / num_columns_, column = block % num_columns_, columns = num_first_columns();
  const int64_t of_block = kSide / step_, first_row = row * of_block, first_column = column * of_block;
  // `first` and `step` lead along the block's own cells, the last two along the first directions of the other one.
  const auto compare = [&](bool is_there, int64_t other, int first, int step, int64_t other_first, int64_t other_step) {
    if (!is_there || state_[other] != State::kUnseen) return;
    for (int k = 0; k < kSide; ++k) {
      const auto of_other = static_cast<size_t>(other_first + k / step_ * other_step);
      if (cells[first + k * step] != first_met_[of_other]) return queue(other);
    }
  };
  const int64_t corner = first_row * columns + first_column;
  compare(column > 0, block - 1, 0, kSide, corner - 1, columns);
  compare(column + 1 < num_columns_, block + 1, kSide - 1, kSide, corner + of_block, columns);
  compare(row > 0, block - num_columns_, 0, 1, corner - columns, 1);
  compare(row + 1 < num_rows_, block + num_columns_, kCells - kSide, 1, corner + of_block * columns, 1);
}

std::vector<int64_t> VisibilityGrid::counts(size_t num_kinds) const {
  std::vector<int64_t> counts(num_kinds);
  const auto add = [&](uint32_t met, int64_t count) {
    if (met != kNothing) counts[met] += count;
  };
  const int64_t columns = num_first_columns(), of_block = kSide / step_;
  for (int64_t first = 0; first < std::ssize(first_met_); ++first) {
    const int64_t block = first / columns / of_block * num_columns_ + first % columns / of_block;
    if (state_[block] != State::kSeen) add(first_met_[first], int64_t{step_} * step_);
  }
  for (size_t block = 0; block < state_.size(); ++block) {
    for (size_t cell = 0; state_[block] == State::kSeen && cell < kCells; ++cell) add(met_[block * kCells + cell], 1);
  }
  return counts;
}

}  // namespace echopath
