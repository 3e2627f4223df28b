#include "echopath/trace/frusta/mirror_frusta.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr double kNoImageWithin = 1e-4;  // m: an antenna or image this near the plane has no image in it
constexpr double kFlatBox = 1e-4;        // m: mirrors may stray this far from their outlines
constexpr size_t kTogether = 512;        // frusta that are followed side by side

std::vector<Box> boxes_of(const std::vector<Mirror>& mirrors) {
  std::vector<Box> boxes;
  for (const Mirror& mirror : mirrors) {
    const Box box = box_about(mirror.outline);
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
  for (const Vec3& rim : rims) region.push_back({rim, rim.dot(image()) - radius});
  region.push_back({lit_normal, offset - radius});  // the last one, because it leaves out least
  return region;
}

FrustumFinder::FrustumFinder(const std::vector<Mirror>& mirrors, const EmbreeScene* geometry, ShadowCasters casters)
    : mirrors_(mirrors), boxes_(boxes_of(mirrors)),
      shadows_(geometry ? std::make_unique<const FrustumShadows>(*geometry, mirrors, std::move(casters)) : nullptr) {}

// Cuts out of a mirror what the frustum (null: the antenna itself), whose source appears at `source`, lights of it; returns
// false where that is nothing.
bool FrustumFinder::cut_window(const MirrorFrustum* frustum, const Vec3& source, const Mirror& mirror, double slack,
                               std::vector<Vec3>& window) const {
  thread_local std::vector<Vec3> spare;
  window = mirror.outline;
  if (!frustum) return !window.empty();
  clip(window, frustum->lit_normal, frustum->offset - slack, spare);
  for (const Vec3& rim : frustum->rims) {
    if (window.empty()) return false;
    clip(window, rim, rim.dot(source) - slack, spare);
  }
  return !window.empty();
}

// Reflects the frustum in one mirror; returns false where it shows nothing.
bool FrustumFinder::reflect(const MirrorFrustum* frustum, const Vec3& source, int index, const FrustumSearch& search,
                            MirrorFrustum& out) const {
  const Mirror& mirror = mirrors_[index];
  if (std::abs(mirror.height(source)) < kNoImageWithin) return false;
  thread_local std::vector<Vec3> window;
  if (!cut_window(frustum, source, mirror, search.slack, window)) return false;
  if (shadows_ && !search.keeps_hidden) {
    const FrustumSource from{source, frustum ? &frustum->lit_normal : nullptr, frustum ? frustum->offset : 0.0};
    shadows_->shrink(from, mirror, window);
    if (window.empty()) return false;
  }
  out = frustum ? *frustum : MirrorFrustum();
  out.window = window;
  out.mirrors.push_back(index);
  const bool is_long = out.mirrors.size() > kMaxLegMirrors;
  out.sequence = is_long ? kLongSequence : extended(out.sequence, index, mirrors_.size());
  out.images.push_back(mirror.image(source));
  out.lit_normal = mirror.normal_toward(source);
  out.offset = out.lit_normal.dot(mirror.point);
  out.rims = rims_of(out.window, out.image());
  return true;
}

// Appends the reflections of the frustum in all mirrors.
void FrustumFinder::extend(const MirrorFrustum* frustum, const Vec3& source, const FrustumSearch& search,
                           std::vector<MirrorFrustum>& out) const {
  std::vector<int> lit;
  boxes_.find(frustum ? frustum->region(search.slack) : std::vector<HalfSpace>(), lit);
  MirrorFrustum next;
  for (const int index : lit) {
    if (frustum && frustum->mirrors.back() == index) continue;
    if (reflect(frustum, source, index, search, next)) out.push_back(std::move(next));
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
    FrustumSearch wanted = search;
    wanted.keeps_hidden = search.keeps_hidden && out.frusta.size() < search.max_frusta / 2;
    Job own(job);
    parallel_for(std::ssize(next), [&](int64_t i) {
      const MirrorFrustum& frustum = out.frusta[first + static_cast<size_t>(i)];
      extend(&frustum, frustum.image(), wanted, next[i]);
    }, &own);
    for (std::vector<MirrorFrustum>& of_one : next) {
      std::move(of_one.begin(), of_one.end(), std::back_inserter(out.frusta));
    }
  }
}

MirrorFrusta FrustumFinder::find(const Vec3& antenna, const FrustumSearch& search, const Job* job) const {
  MirrorFrusta out;
  FrustumSearch level = search;
  for (level.max_mirrors = 1; level.max_mirrors <= search.max_mirrors; ++level.max_mirrors)
    lengthen(antenna, level, out, job);
  return out;
}

void FrustumFinder::lengthen(const Vec3& antenna, const FrustumSearch& search, MirrorFrusta& out, const Job* job) const {
  if (search.max_mirrors == 1) return extend(nullptr, antenna, search, out.frusta);
  const auto has_fewer = [&](const MirrorFrustum& one) {
    return static_cast<int>(one.mirrors.size()) < search.max_mirrors - 1;
  };
  const auto begin = std::partition_point(out.frusta.begin(), out.frusta.end(), has_fewer);
  follow(static_cast<size_t>(begin - out.frusta.begin()), out.frusta.size(), search, job, out);
}

}  // namespace echopath
