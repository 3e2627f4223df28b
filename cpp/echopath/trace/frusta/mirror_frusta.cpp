#include "echopath/trace/frusta/mirror_frusta.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr double kNoImageWithin = 1e-4;  // m: an antenna or image this near the plane has no image in it
constexpr double kFlatBox = 1e-4;        // m: mirrors may stray this far from their outlines
constexpr size_t kTogether = 512;        // frusta that are followed side by side

std::vector<Eigen::AlignedBox3d> boxes_of(const std::vector<Mirror>& mirrors) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Mirror& mirror : mirrors) {
    Eigen::AlignedBox3d box;
    for (const Vec3& corner : mirror.outline) box.extend(corner);
    boxes.emplace_back(box.min().array() - kFlatBox, box.max().array() + kFlatBox);
  }
  return boxes;
}

}  // namespace

bool MirrorFrustum::reaches(const Vec3& point, double radius) const {
  if (lit_normal.dot(point) - offset < -radius) return false;
  const Vec3 line = point - image();
  for (const Vec3& rim : rims) {
    if (rim.dot(line) < -radius) return false;
  }
  return true;
}

std::vector<HalfSpace> MirrorFrustum::region(double radius) const {
  std::vector<HalfSpace> region;
  region.reserve(rims.size() + 1);
  region.push_back({lit_normal, offset - radius});
  for (const Vec3& rim : rims) region.push_back({rim, rim.dot(image()) - radius});
  return region;
}

FrustumFinder::FrustumFinder(const std::vector<Mirror>& mirrors, const EmbreeScene* geometry)
    : mirrors_(mirrors), boxes_(boxes_of(mirrors)),
      shadows_(geometry ? std::make_unique<const FrustumShadows>(*geometry, mirrors) : nullptr) {}

// Reflects the frustum (null: the antenna itself), whose source appears at `source`, in one mirror; returns false where it
// shows nothing.
bool FrustumFinder::reflect(const MirrorFrustum* frustum, const Vec3& source, int index, double slack,
                            MirrorFrustum& out) const {
  const Mirror& mirror = mirrors_[static_cast<size_t>(index)];
  if (std::abs(mirror.height(source)) < kNoImageWithin) return false;
  thread_local std::vector<Vec3> window, spare;
  window = mirror.outline;
  if (frustum) {
    clip(window, frustum->lit_normal, frustum->offset - slack, spare);
    for (const Vec3& rim : frustum->rims) {
      if (window.empty()) return false;
      clip(window, rim, rim.dot(source) - slack, spare);
    }
  }
  if (shadows_ && !window.empty()) {
    const FrustumSource from{source, frustum ? &frustum->lit_normal : nullptr, frustum ? frustum->offset : 0.0};
    shadows_->shrink(from, mirror, window);
  }
  if (window.empty()) return false;
  if (frustum) {
    out.mirrors = frustum->mirrors;
    out.images = frustum->images;
  }
  out.window = window;
  out.mirrors.push_back(index);
  const bool is_long = out.mirrors.size() > kMaxLegMirrors;
  const MirrorSequence before = frustum ? frustum->sequence : kNoMirrors;
  out.sequence = is_long ? kLongSequence : extended(before, index, mirrors_.size());
  out.images.push_back(mirror.image(source));
  out.lit_normal = mirror.normal_toward(source);
  out.offset = out.lit_normal.dot(mirror.point);
  out.rims = rims_of(out.window, out.image());
  return true;
}

// Appends the reflections of the frustum in all mirrors.
void FrustumFinder::extend(const MirrorFrustum* frustum, const Vec3& source, double slack,
                           std::vector<MirrorFrustum>& out) const {
  std::vector<int> lit;
  boxes_.find(frustum ? frustum->region(slack) : std::vector<HalfSpace>(), lit);
  for (const int index : lit) {
    if (frustum && frustum->mirrors.back() == index) continue;
    MirrorFrustum next;
    if (reflect(frustum, source, index, slack, next)) out.push_back(std::move(next));
  }
}

// Appends the frusta that follow on the frusta [begin, end) of `out`, as far as there is room.
void FrustumFinder::follow(size_t begin, size_t end, const FrustumSearch& search, const Job* job, MirrorFrusta& out) const {
  for (size_t first = begin; first < end; first += kTogether) {
    if (out.frusta.size() >= search.max_frusta) {
      out.num_unfollowed += static_cast<int64_t>(end - first);
      return;
    }
    std::vector<std::vector<MirrorFrustum>> next(std::min(kTogether, end - first));
    Job own(job);
    parallel_for(std::ssize(next), [&](int64_t i) {
      const MirrorFrustum& frustum = out.frusta[first + static_cast<size_t>(i)];
      extend(&frustum, frustum.image(), search.slack, next[static_cast<size_t>(i)]);
    }, &own);
    for (std::vector<MirrorFrustum>& of_one : next) {
      std::move(of_one.begin(), of_one.end(), std::back_inserter(out.frusta));
    }
  }
}

MirrorFrusta FrustumFinder::find(const Vec3& antenna, const FrustumSearch& search, const Job* job) const {
  MirrorFrusta out;
  if (search.max_mirrors > 0) extend(nullptr, antenna, search.slack, out.frusta);
  size_t begin = 0;
  for (int count = 1; count < search.max_mirrors && begin < out.frusta.size(); ++count) {
    const size_t end = out.frusta.size();
    follow(begin, end, search, job, out);
    begin = end;
  }
  return out;
}

}  // namespace echopath
