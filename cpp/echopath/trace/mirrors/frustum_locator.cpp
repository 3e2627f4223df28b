#include "echopath/trace/mirrors/frustum_locator.h"

#include <numeric>

namespace echopath {
namespace {

constexpr size_t kFewFrusta = 16;        // up to this many are looked at one by one
constexpr int kMaxHalvings = 21;         // of the space, until a cell is left whole
constexpr size_t kMaxEntries = 8 << 20;  // of all cells; beyond that none is halved
constexpr double kWorth = 0.9;           // halves that hold more than this share of the frusta are in vain,
constexpr int kMaxVain = 4;              // and a cell is halved no further after so many in a row
constexpr double kAround = 0.25;         // share of the extent of the mirrors by which the cells reach beyond them

}  // namespace

FrustumLocator::FrustumLocator(const std::vector<MirrorFrustum>& frusta, double radius) : all_(frusta.size()) {
  std::iota(all_.begin(), all_.end(), 0);
  if (frusta.size() <= kFewFrusta) return;
  Regions regions;
  for (const MirrorFrustum& frustum : frusta) {
    regions.push_back(frustum.region(radius));
    for (const Vec3& corner : frustum.window) box_.extend(corner);
  }
  const Vec3 around = Vec3::Constant(kAround * box_.sizes().maxCoeff());
  box_ = Eigen::AlignedBox3d(Vec3(box_.min() - around), Vec3(box_.max() + around));
  grow(regions, box_, all_, 0, 0);
}

int FrustumLocator::grow(const Regions& regions, const Eigen::AlignedBox3d& box, std::vector<int> reaching, int depth,
                         int num_vain) {
  const auto index = cells_.size();
  cells_.emplace_back();
  const bool is_full = entries_.size() + reaching.size() > kMaxEntries;
  if (reaching.size() <= kFewFrusta || depth == kMaxHalvings || num_vain == kMaxVain || is_full) {
    cells_[index].begin = entries_.size();
    entries_.insert(entries_.end(), reaching.begin(), reaching.end());
    cells_[index].end = entries_.size();
    return static_cast<int>(index);
  }
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const double split = box.center()[axis];
  std::array<Eigen::AlignedBox3d, 2> halves = {box, box};
  halves[0].max()[axis] = halves[1].min()[axis] = split;
  std::array<std::vector<int>, 2> of_half;
  for (size_t side = 0; side < 2; ++side) {
    for (const int frustum : reaching) {
      if (reaches_into(halves[side], regions[static_cast<size_t>(frustum)])) of_half[side].push_back(frustum);
    }
  }
  const auto kept = static_cast<double>(of_half[0].size() + of_half[1].size());
  const int vain = kept > 2.0 * kWorth * static_cast<double>(reaching.size()) ? num_vain + 1 : 0;
  reaching = {};
  cells_[index].axis = static_cast<int>(axis);
  cells_[index].split = split;
  grow(regions, halves[0], std::move(of_half[0]), depth + 1, vain);
  const int second = grow(regions, halves[1], std::move(of_half[1]), depth + 1, vain);
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
