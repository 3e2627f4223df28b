#include "echopath/base/box_tree.h"

#include <algorithm>
#include <numeric>

namespace echopath {
namespace {

constexpr uint32_t kThingsBetweenChecks = 1 << 14;  // larger branches check for cancellation, some milliseconds apart

}  // namespace

BoxTree::BoxTree(uint32_t size, const std::function<Box(uint32_t)>& box_of, uint32_t leaf_size, const Job* job)
    : order_(size) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (size == 0) return;
  std::vector<Middle> middles(size);
  const Eigen::Vector3d origin = box_of(0).center();
  for (uint32_t i = 0; i < size; ++i)
    Eigen::Map<Eigen::Vector3f>(middles[i].data()) = (box_of(i).center() - origin).cast<float>();
  halve(0, size, middles, leaf_size, job);
  for (size_t index = branches_.size(); index-- > 0;) {
    Branch& branch = branches_[index];
    if (branch.second_half != 0) branch.box = branches_[index + 1].box.merged(branches_[branch.second_half].box);
    else
      for (uint32_t place = branch.begin; place < branch.end; ++place) branch.box.extend(box_of(order_[place]));
  }
}

void BoxTree::halve(uint32_t begin, uint32_t end, const std::vector<Middle>& middles, uint32_t leaf_size, const Job* job) {
  if (job && end - begin >= kThingsBetweenChecks) job->throw_if_cancelled();
  const size_t index = branches_.size();
  branches_.push_back({Box(), begin, end, 0});
  if (end - begin <= leaf_size) return;
  uint32_t* const first = order_.data() + begin;
  uint32_t* const last = order_.data() + end;
  Eigen::AlignedBox3f spread;
  for (const uint32_t* i = first; i != last; ++i) spread.extend(Eigen::Map<const Eigen::Vector3f>(middles[*i].data()));
  Eigen::Index longest = 0;
  spread.sizes().maxCoeff(&longest);
  const uint32_t half = begin + (end - begin) / 2;
  std::nth_element(first, order_.data() + half, last, [&](uint32_t a, uint32_t b) {
    return middles[a][longest] != middles[b][longest] ? middles[a][longest] < middles[b][longest] : a < b;
  });
  halve(begin, half, middles, leaf_size, job);
  branches_[index].second_half = static_cast<uint32_t>(branches_.size());
  halve(half, end, middles, leaf_size, job);
}

}  // namespace echopath
