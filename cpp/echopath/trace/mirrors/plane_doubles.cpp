#include "echopath/trace/mirrors/plane_doubles.h"

#include <algorithm>
#include <utility>

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

std::vector<int> sorted(std::vector<int> planes) {
  std::ranges::sort(planes);
  return planes;
}

}  // namespace

struct PlaneDoubles::Sequence {
  std::vector<int> planes, ascending;
};

bool OrdersAboutCorners::contain(const std::vector<int>& sequence) const {
  int64_t begin = 0;
  return std::ranges::all_of(ends, [&](int64_t end) {
    const int64_t first = std::exchange(begin, end);
    return std::is_permutation(sequence.begin() + first, sequence.begin() + end, planes.begin() + first);
  });
}

void PlaneDoubles::add(OrdersAboutCorners orders) {
  std::vector<int> planes = sorted(orders.planes);
  left_out_[std::move(planes)].push_back(std::move(orders));
}

bool PlaneDoubles::is_same(const PlaneDoubles& other, std::span<const uint32_t> id_there) const {
  if (left_out_ != other.left_out_) return false;
  if (!any()) return true;
  const auto has_planes = [](const std::vector<int>& planes) { return !planes.empty(); };
  const auto num_with_planes = [&](const PlaneDoubles& of) {
    return std::ranges::count_if(of.plane_of_triangle, has_planes);
  };
  for (size_t id = 0; id < plane_of_triangle.size(); ++id) {
    if (!has_planes(plane_of_triangle[id])) continue;
    const uint32_t there = id_there[id];
    if (there >= other.plane_of_triangle.size() || other.plane_of_triangle[there] != plane_of_triangle[id]) return false;
  }
  return num_with_planes(*this) == num_with_planes(other);
}

const OrdersAboutCorners* PlaneDoubles::find(const Paths& paths, size_t path, Sequence& of_path) const {
  const Hit* hits = paths.hits_of(static_cast<int64_t>(path));
  of_path.planes.clear();
  for (int k = 0; k < paths.num_bounces[path]; ++k) {
    const std::vector<int>& of_triangle = plane_of_triangle[hits[k].mesh_id];
    const int plane = of_triangle.empty() ? -1 : of_triangle[hits[k].triangle_id];
    if (plane < 0) return nullptr;
    of_path.planes.push_back(plane);
  }
  of_path.ascending = of_path.planes;
  std::ranges::sort(of_path.ascending);
  const auto same_planes = left_out_.find(of_path.ascending);
  if (same_planes == left_out_.end()) return nullptr;
  for (const OrdersAboutCorners& orders : same_planes->second) {
    if (orders.contain(of_path.planes)) return &orders;
  }
  return nullptr;
}

PlaneDoubles PlaneDoubles::of_images_in(const Paths& paths) const {
  PlaneDoubles of_images;
  if (!any()) return of_images;
  of_images.plane_of_triangle = plane_of_triangle;
  Sequence of_path;
  for (size_t path = 0; path < paths.offsets.size(); ++path) {
    if (!paths.is_over_images_alone(path)) continue;
    if (const OrdersAboutCorners* orders = find(paths, path, of_path)) of_images.add(*orders);
  }
  return of_images;
}

std::vector<uint8_t> PlaneDoubles::doubles_in(const Paths& paths, Job* job) const {
  std::vector<uint8_t> doubles(paths.num_paths());
  if (!any()) return doubles;
  constexpr int64_t kTogether = 1 << 14;
  parallel_for_chunks(paths.num_paths(), kTogether, [&](int64_t begin, int64_t end) {
    Sequence of_path;
    for (int64_t path = begin; path < end; ++path) {
      doubles[path] = paths.is_coherent_with_cell(path) && find(paths, path, of_path);
    }
  }, job);
  return doubles;
}

void PlaneDoubles::leave_out(Paths& paths, Job* job) const {
  if (!any()) return;
  Job own(job);
  std::vector<uint8_t> keep = doubles_in(paths, &own);
  for (uint8_t& is_kept : keep) is_kept = !is_kept;
  paths = paths.select(keep, &own);
  paths.frame.statistics.num_paths = paths.num_paths();  // what is left is the whole record
}

}  // namespace echopath
