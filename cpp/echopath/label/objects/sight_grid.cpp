#include "echopath/label/objects/sight_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace echopath {
namespace {

constexpr int kCells = SightGrid::kSide * SightGrid::kSide;  // of a block; as many as a packet has lanes
static_assert(kCells == kPacketSize);
constexpr int kFirstCell = 5;  // the cell of a block that is looked at first
// Two numbers whose multiples are even in both axes together (Roberts 2018, of the plastic number).
constexpr double kAlong = 0.7548776662466927, kAcross = 0.5698402909980532;

double fraction(double value) { return value - std::floor(value); }

}  // namespace

SightGrid::SightGrid(const Stratum& stratum, int64_t num_cells) : directions_({stratum}) {
  const LaunchDomain domain = domain_of(stratum);
  is_disc_ = domain.is_disc();
  half_ = is_disc_ ? Eigen::Vector2d(1.0, 1.0) : domain.half;
  const double num_blocks = std::max(1.0, static_cast<double>(num_cells) / kCells);
  num_columns_ = static_cast<int>(std::clamp(std::round(std::sqrt(num_blocks * half_[0] / half_[1])), 1.0, num_blocks));
  num_rows_ = static_cast<int>(std::max(1.0, std::round(num_blocks / num_columns_)));
  const double square = is_disc_ ? 4.0 / std::numbers::pi : 1.0;  // of the disc's own area
  cell_angle_ = stratum.solid_angle() * square / static_cast<double>(kCells * this->num_blocks());
  const auto size = static_cast<size_t>(this->num_blocks());
  first_met_.assign(size, kNothing);
  state_.assign(size, State::kUnseen);
  met_.resize(size * kCells);
}

// Sets the place of a cell's direction in the domain.
void SightGrid::direct(int64_t block, int cell, LaneValues& x, LaneValues& y, int lane) const {
  const auto column = static_cast<double>(block % num_columns_ * kSide + cell % kSide);
  const int64_t whole_rows = block / num_columns_ * kSide + cell / kSide;
  const auto row = static_cast<double>(whole_rows);
  const double along = column + fraction(kAlong * row + 0.5), across = row + fraction(kAcross * column + 0.5);
  x[lane] = half_[0] * (2.0 * along / (kSide * num_columns_) - 1.0);
  y[lane] = half_[1] * (2.0 * across / (kSide * num_rows_) - 1.0);
}

// Places outside of a disc meet nothing.
void SightGrid::look_at(const LaneValues& x, const LaneValues& y, int count, const FindMet& find_met, uint32_t* met) const {
  LaneVectors directions;
  directions_.launch(0, x, y, {0, kPacketSize}, directions);
  find_met(directions, count, met);
  for (int lane = 0; is_disc_ && lane < count; ++lane) {
    if (x[lane] * x[lane] + y[lane] * y[lane] > 1.0) met[lane] = kNothing;
  }
}

double SightGrid::start(const FindMet& find_met) {
  if (num_blocks() <= kFewBlocks) finish_everywhere(find_met);
  else look_at_first_cells(find_met);
  const auto& all = num_blocks() > kFewBlocks ? first_met_ : met_;
  const auto num_found = std::ssize(all) - std::count(all.begin(), all.end(), kNothing);
  return static_cast<double>(num_found) / static_cast<double>(all.size());
}

// Looks at squares of blocks: nearly parallel rays are faster.
void SightGrid::look_at_first_cells(const FindMet& find_met) {
  for (int row = 0; row < num_rows_; row += kSide) {
    for (int column = 0; column < num_columns_; column += kSide) {
      const int columns = std::min(kSide, num_columns_ - column), count = columns * std::min(kSide, num_rows_ - row);
      const auto block = [&](int lane) { return int64_t{row + lane / columns} * num_columns_ + column + lane % columns; };
      LaneValues x, y;
      for (int lane = 0; lane < kPacketSize; ++lane) direct(block(std::min(lane, count - 1)), kFirstCell, x, y, lane);
      std::array<uint32_t, kPacketSize> met;
      look_at(x, y, count, find_met, met.data());
      for (int lane = 0; lane < count; ++lane) first_met_[static_cast<size_t>(block(lane))] = met[static_cast<size_t>(lane)];
    }
  }
}

void SightGrid::finish(const FindMet& find_met) {
  queue_changes();
  while (!queue_.empty()) {
    const int64_t block = queue_.back();
    queue_.pop_back();
    see(block, find_met);
    queue_neighbours(block);
  }
}

void SightGrid::finish_everywhere(const FindMet& find_met) {
  for (int64_t block = 0; block < num_blocks(); ++block) see(block, find_met);
}

void SightGrid::see(int64_t block, const FindMet& find_met) {
  const auto at = static_cast<size_t>(block);
  if (state_[at] == State::kSeen) return;
  LaneValues x, y;
  for (int cell = 0; cell < kCells; ++cell) direct(block, cell, x, y, cell);
  look_at(x, y, kCells, find_met, met_.data() + at * kCells);
  state_[at] = State::kSeen;
}

void SightGrid::queue(int64_t block) {
  State& state = state_[static_cast<size_t>(block)];
  if (state != State::kUnseen) return;
  state = State::kQueued;
  queue_.push_back(block);
}

// Queues one of two neighbours whose directions met different things: where the change is in the other one, the cells at
// their border lead there. Around the domain nothing is met.
void SightGrid::queue_changes() {
  const auto met = [&](int64_t block) { return first_met_[static_cast<size_t>(block)]; };
  for (int64_t block = 0; block < num_blocks(); ++block) {
    const int64_t column = block % num_columns_;
    const bool has_right = column + 1 < num_columns_, has_below = block + num_columns_ < num_blocks();
    const bool is_at_rim = column == 0 || !has_right || block < num_columns_ || !has_below;
    if (is_at_rim && met(block) != kNothing) queue(block);
    const bool differs_right = has_right && met(block) != met(block + 1);
    const bool differs_below = has_below && met(block) != met(block + num_columns_);
    if (differs_right || differs_below) queue(block);
  }
}

// Queues the neighbours of a block that was seen where cells at their border met something else than they did.
void SightGrid::queue_neighbours(int64_t block) {
  const uint32_t* const cells = met_.data() + block * kCells;
  const int64_t column = block % num_columns_;
  const auto compare = [&](bool is_there, int64_t other, int first, int step) {
    if (!is_there || state_[static_cast<size_t>(other)] != State::kUnseen) return;
    const uint32_t met = first_met_[static_cast<size_t>(other)];
    for (int k = 0; k < kSide; ++k) {
      if (cells[first + k * step] != met) return queue(other);
    }
  };
  compare(column > 0, block - 1, 0, kSide);
  compare(column + 1 < num_columns_, block + 1, kSide - 1, kSide);
  compare(block >= num_columns_, block - num_columns_, 0, 1);
  compare(block + num_columns_ < num_blocks(), block + num_columns_, kCells - kSide, 1);
}

std::vector<int64_t> SightGrid::counts(size_t num_kinds) const {
  std::vector<int64_t> counts(num_kinds);
  const auto add = [&](uint32_t met, int64_t count) {
    if (met != kNothing) counts[met] += count;
  };
  for (size_t block = 0; block < state_.size(); ++block) {
    if (state_[block] != State::kSeen) add(first_met_[block], kCells);
    else
      for (int cell = 0; cell < kCells; ++cell) add(met_[block * kCells + static_cast<size_t>(cell)], 1);
  }
  return counts;
}

}  // namespace echopath
