#include "echopath/trace/frusta/frustum_locator.h"

#include <algorithm>
#include <array>
#include <numeric>

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
Reach reach_into(const Eigen::AlignedBox3d& box, std::span<const HalfSpace> region) {
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

// Holds a cell that is about to be halved, and which frusta reach into it.
struct FrustumLocator::Growth {
  Eigen::AlignedBox3d box;
  std::vector<int> holding, crossing;  // all of the cell, a part of it; both ascending
  int depth = 0, num_vain = 0;

  size_t size() const { return holding.size() + crossing.size(); }
};

FrustumLocator::FrustumLocator(std::span<const MirrorFrustum> frusta, double radius) : all_(frusta.size()) {
  std::iota(all_.begin(), all_.end(), 0);
  if (frusta.size() <= kFewFrusta) return;
  Regions regions;
  for (const MirrorFrustum& frustum : frusta) {
    const std::vector<HalfSpace> region = frustum.region(radius);
    regions.begin.push_back(regions.halves.size());
    regions.halves.insert(regions.halves.end(), region.begin(), region.end());
    for (const Vec3& corner : frustum.window) box_.extend(corner);
  }
  regions.begin.push_back(regions.halves.size());
  const Vec3 around = Vec3::Constant(kAround * box_.sizes().maxCoeff());
  box_ = Eigen::AlignedBox3d(Vec3(box_.min() - around), Vec3(box_.max() + around));
  grow(regions, {box_, {}, all_, 0, 0});
}

// A frustum that holds all of a cell holds its halves, too, and is looked at no more.
FrustumLocator::Growth FrustumLocator::half_of(const Regions& regions, const Growth& whole, const Eigen::AlignedBox3d& box) {
  Growth half{box, whole.holding, {}, whole.depth + 1, 0};
  const auto num_before = std::ssize(half.holding);
  for (const int frustum : whole.crossing) {
    const Reach reach = reach_into(box, regions.of(frustum));
    if (reach == Reach::kWhole) half.holding.push_back(frustum);
    if (reach == Reach::kPart) half.crossing.push_back(frustum);
  }
  std::inplace_merge(half.holding.begin(), half.holding.begin() + num_before, half.holding.end());
  return half;
}

void FrustumLocator::end_with(const Growth& cell, size_t index) {
  cells_[index].begin = entries_.size();
  std::merge(cell.holding.begin(), cell.holding.end(), cell.crossing.begin(), cell.crossing.end(),
             std::back_inserter(entries_));
  cells_[index].end = entries_.size();
}

int FrustumLocator::grow(const Regions& regions, Growth cell) {
  const auto index = cells_.size();
  cells_.emplace_back();
  const bool is_full = entries_.size() + cell.size() > kMaxEntries;
  if (cell.size() <= kFewFrusta || cell.depth == kMaxHalvings || cell.num_vain == kMaxVain || is_full) {
    end_with(cell, index);
    return static_cast<int>(index);
  }
  Eigen::Index axis = 0;
  cell.box.sizes().maxCoeff(&axis);
  const double split = cell.box.center()[axis];
  std::array<Eigen::AlignedBox3d, 2> boxes = {cell.box, cell.box};
  boxes[0].max()[axis] = boxes[1].min()[axis] = split;
  Growth below = half_of(regions, cell, boxes[0]), above = half_of(regions, cell, boxes[1]);
  const auto kept = static_cast<double>(below.size() + above.size());
  below.num_vain = above.num_vain = kept > 2.0 * kWorth * static_cast<double>(cell.size()) ? cell.num_vain + 1 : 0;
  cell = {};
  cells_[index].axis = static_cast<int>(axis);
  cells_[index].split = split;
  grow(regions, std::move(below));
  const int second = grow(regions, std::move(above));
  cells_[index].second = second;
  return static_cast<int>(index);
}

std::span<const int> FrustumLocator::near(const Vec3& point) const {
  if (cells_.empty() || !box_.contains(point)) return all_;
  size_t at = 0;
  while (cells_[at].axis >= 0)
    at = point[cells_[at].axis] < cells_[at].split ? at + 1 : static_cast<size_t>(cells_[at].second);
  return {entries_.data() + cells_[at].begin, cells_[at].end - cells_[at].begin};
}

}  // namespace echopath
