#include "echopath/trace/frusta/frustum_locator.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <numeric>
#include <vector>

namespace echopath {
namespace {

constexpr size_t kFewFrusta = 16;        // up to this many are looked at one by one
constexpr int kMaxHalvings = 21;         // of the space, until a cell is left whole
constexpr size_t kMaxEntries = 8 << 20;  // of all cells; beyond that none is halved
constexpr double kWorth = 0.9;           // halves that hold more than this share of the frusta are in vain,
constexpr int kMaxVain = 4;              // and a cell is halved no further after so many in a row
constexpr double kAround = 0.25;         // share of the extent of the mirrors by which the cells reach beyond them

enum class Reach { kNone, kPart, kWhole };

// Tells how much of a box lies in an intersection of half-spaces; kPart may be said of a box that is beside it.
Reach reach_into(const Box& box, std::span<const HalfSpace> region) {
  const Vec3 centre = box.center(), half = 0.5 * box.sizes();
  Reach reach = Reach::kWhole;
  for (const HalfSpace& one : region) {
    const double inside = one.normal.dot(centre) - one.offset, around = one.normal.cwiseAbs().dot(half);
    if (inside < -around) return Reach::kNone;
    if (inside < around) reach = Reach::kPart;
  }
  return reach;
}

}  // namespace

class FrustumLocator::Cells {
 public:
  Cells(std::span<const MirrorFrustum> frusta, double radius) : all_(frusta.size()) {
    std::iota(all_.begin(), all_.end(), 0);
    if (frusta.size() <= kFewFrusta) return;
    for (const MirrorFrustum& frustum : frusta) {
      const std::vector<HalfSpace> region = frustum.region(radius);
      begin_.push_back(halves_.size());
      halves_.insert(halves_.end(), region.begin(), region.end());
      for (const Vec3& corner : frustum.window) root_.box.extend(corner);
    }
    begin_.push_back(halves_.size());
    const Vec3 around = Vec3::Constant(kAround * root_.box.sizes().maxCoeff());
    root_.box = Box(Vec3(root_.box.min() - around), Vec3(root_.box.max() + around));
    root_.crossing = all_;
    num_entries_ = root_.size();
  }

  std::span<const int> near(const Vec3& point) {
    if (!root_.box.contains(point)) return all_;  // also where there are few: then it is empty
    Cell* at = &root_;
    for (;;) {
      if (!at->is_settled.load(std::memory_order_acquire)) settle(*at);
      if (!at->parts) return at->holding;
      at = &(*at->parts)[point[at->axis] < at->split ? 0 : 1];
    }
  }

 private:
  struct Cell {
    Box box;
    std::vector<int> holding, crossing;  // frusta that reach into all of the cell and into a part of it; both ascending
    int depth = 0, num_vain = 0;
    std::atomic<bool> is_settled = false;        // all below is for good
    int axis = 0;                                // along which it is halved
    double split = 0.0;                          // m
    std::unique_ptr<std::array<Cell, 2>> parts;  // below and above; none: it is not halved, and `holding` are all frusta

    size_t size() const { return holding.size() + crossing.size(); }
  };

  std::span<const HalfSpace> region_of(int frustum) const {
    return {halves_.data() + begin_[frustum], begin_[frustum + 1] - begin_[frustum]};
  }

  // A frustum that holds all of a cell holds its halves, too, and is looked at no more.
  void fill(const Cell& whole, Cell& half) const {
    half.holding = whole.holding;
    half.depth = whole.depth + 1;
    const auto num_before = std::ssize(half.holding);
    for (const int frustum : whole.crossing) {
      const Reach reach = reach_into(half.box, region_of(frustum));
      if (reach == Reach::kWhole) half.holding.push_back(frustum);
      if (reach == Reach::kPart) half.crossing.push_back(frustum);
    }
    std::inplace_merge(half.holding.begin(), half.holding.begin() + num_before, half.holding.end());
  }

  void settle(Cell& cell) {
    const std::lock_guard lock(growing_);
    if (cell.is_settled.load(std::memory_order_relaxed)) return;
    const bool is_full = num_entries_ + cell.size() > kMaxEntries;
    if (cell.size() > kFewFrusta && cell.depth < kMaxHalvings && cell.num_vain < kMaxVain && !is_full) halve(cell);
    else end_with(cell);
    cell.is_settled.store(true, std::memory_order_release);
  }

  void halve(Cell& cell) {
    Eigen::Index axis = 0;
    cell.box.sizes().maxCoeff(&axis);
    cell.axis = static_cast<int>(axis);
    cell.split = cell.box.center()[axis];
    cell.parts = std::make_unique<std::array<Cell, 2>>();
    Cell &below = (*cell.parts)[0], &above = (*cell.parts)[1];
    below.box = above.box = cell.box;
    below.box.max()[axis] = above.box.min()[axis] = cell.split;
    fill(cell, below);
    fill(cell, above);
    const size_t kept = below.size() + above.size();
    const bool is_vain = static_cast<double>(kept) > 2.0 * kWorth * static_cast<double>(cell.size());
    below.num_vain = above.num_vain = is_vain ? cell.num_vain + 1 : 0;
    num_entries_ += kept - cell.size();
    cell.holding = std::vector<int>();
    cell.crossing = std::vector<int>();
  }

  static void end_with(Cell& cell) {
    const auto num_holding = std::ssize(cell.holding);
    cell.holding.insert(cell.holding.end(), cell.crossing.begin(), cell.crossing.end());
    std::inplace_merge(cell.holding.begin(), cell.holding.begin() + num_holding, cell.holding.end());
    cell.crossing = std::vector<int>();
  }

  std::vector<int> all_;           // frusta that may reach a point outside of the cells
  std::vector<HalfSpace> halves_;  // of the regions of the frusta, side by side
  std::vector<size_t> begin_;      // [frusta + 1] into halves_
  std::mutex growing_;             // held while a cell is settled
  Cell root_;
  size_t num_entries_ = 0;  // of all cells that are not halved
};

FrustumLocator::FrustumLocator(std::span<const MirrorFrustum> frusta, double radius)
    : cells_(std::make_shared<Cells>(frusta, radius)) {}

std::span<const int> FrustumLocator::near(const Vec3& point) const {
  return cells_ ? cells_->near(point) : std::span<const int>();
}

}  // namespace echopath
