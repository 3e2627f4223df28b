#include "echopath/trace/live/queried_space.h"

#include <algorithm>
#include <cmath>

#include "echopath/trace/embree/embree_device.h"

namespace echopath {
namespace {

thread_local QueriedSpace* watched = nullptr;

QueriedSpace::Point start_of(const RTCRay& ray) { return {ray.org_x, ray.org_y, ray.org_z}; }

QueriedSpace::Point point_at(const RTCRay& ray, float distance) {
  return {ray.org_x + distance * ray.dir_x, ray.org_y + distance * ray.dir_y, ray.org_z + distance * ray.dir_z};
}

RTCRay ray_of(const RTCRay16& rays, int lane) {
  RTCRay ray;
  ray.org_x = rays.org_x[lane];
  ray.org_y = rays.org_y[lane];
  ray.org_z = rays.org_z[lane];
  ray.dir_x = rays.dir_x[lane];
  ray.dir_y = rays.dir_y[lane];
  ray.dir_z = rays.dir_z[lane];
  ray.tfar = rays.tfar[lane];
  return ray;
}

}  // namespace

void QueriedSpace::add(const Point& from, const Point& to) {
  const float a[3] = {from.x, from.y, from.z}, b[3] = {to.x, to.y, to.z};
  const bool is_first = num_in_last_ == kPacketSize;
  if (is_first) {
    packs_.emplace_back();
    boxes_.emplace_back();
    num_in_last_ = 0;
  }
  Pack& pack = packs_.back();
  for (int axis = 0; axis < 3; ++axis) {
    const float middle = 0.5f * (a[axis] + b[axis]), half = 0.5f * (b[axis] - a[axis]);
    if (is_first) {
      std::fill_n(pack.middle[axis], kPacketSize, middle);
      std::fill_n(pack.half[axis], kPacketSize, half);
    }
    pack.middle[axis][num_in_last_] = middle;
    pack.half[axis][num_in_last_] = half;
  }
  FloatBox& box = boxes_.back();
  box.extend(Eigen::Vector3f(from.x, from.y, from.z));
  box.extend(Eigen::Vector3f(to.x, to.y, to.z));
  whole_.extend(box);
  ++num_in_last_;
}

// A segment misses a box where one of the six axes (those of the box, and their cross products with the segment) separates
// them. Source: Gottschalk, Lin, Manocha 1996.
bool QueriedSpace::meets(const Pack& pack, const FloatBox& box) const {
  const Eigen::Vector3f centre = box.center(), half = 0.5f * box.sizes();
  const float cx = centre.x(), cy = centre.y(), cz = centre.z(), hx = half.x(), hy = half.y(), hz = half.z();
  int met = 0;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    const float x = pack.middle[0][lane] - cx, y = pack.middle[1][lane] - cy, z = pack.middle[2][lane] - cz;
    const float dx = pack.half[0][lane], dy = pack.half[1][lane], dz = pack.half[2][lane];
    const float ax = std::abs(dx), ay = std::abs(dy), az = std::abs(dz);
    const int along = (std::abs(x) <= hx + ax) & (std::abs(y) <= hy + ay) & (std::abs(z) <= hz + az);
    const int across = (std::abs(y * dz - z * dy) <= hy * az + hz * ay) & (std::abs(z * dx - x * dz) <= hx * az + hz * ax) &
                       (std::abs(x * dy - y * dx) <= hx * ay + hy * ax);
    met |= along & across;
  }
  return met != 0;
}

bool QueriedSpace::meets(const FloatBox& box) const {
  if (!whole_.intersects(box)) return false;
  for (size_t i = 0; i < packs_.size(); ++i) {
    if (boxes_[i].intersects(box) && meets(packs_[i], box)) return true;
  }
  return false;
}

bool QueriedSpace::meets(std::span<const FloatBox> boxes) const {
  return std::ranges::any_of(boxes, [&](const FloatBox& box) { return meets(box); });
}

void QueriedSpace::clear() {
  packs_.clear();
  boxes_.clear();
  whole_.setEmpty();
  num_in_last_ = kPacketSize;
}

class QueryWatch::Queries final : public EmbreeScene::Queries {
 public:
  Queries(const EmbreeScene::Queries& queries, double reach) : asked_(queries), reach_(static_cast<float>(reach)) {}

  void intersect(RTCRayHit& query) const override {
    asked_.intersect(query);
    add(query.ray, query.ray.tfar);
  }

  void intersect(const ValidLanes& valid, RTCRayHit16& packet, PacketWay way) const override {
    asked_.intersect(valid, packet, way);
    for (int lane = 0; watched && lane < kPacketSize; ++lane) {
      if (valid.lanes[lane]) add(ray_of(packet.ray, lane), packet.ray.tfar[lane]);
    }
  }

  void occluded(RTCRay& ray) const override {
    add(ray, ray.tfar);
    asked_.occluded(ray);
  }

  void occluded(const ValidLanes& valid, RTCRay16& rays) const override {
    for (int lane = 0; watched && lane < kPacketSize; ++lane) {
      if (valid.lanes[lane]) add(ray_of(rays, lane), rays.tfar[lane]);
    }
    asked_.occluded(valid, rays);
  }

  const EmbreeScene::Queries& asked() const { return asked_; }

 private:
  void add(const RTCRay& ray, float far) const {
    if (watched) watched->add(start_of(ray), point_at(ray, std::min(far, reach_)));
  }

  const EmbreeScene::Queries& asked_;
  float reach_;  // m: from the scene's end to end
};

QueryWatch::QueryWatch(EmbreeScene& geometry)
    : geometry_(geometry), queries_(new Queries(geometry.queries(), geometry.reach())) {
  geometry_.ask_through(*queries_);
}

QueryWatch::~QueryWatch() { geometry_.ask_through(queries_->asked()); }

QueryWatch::OfThread::OfThread(QueriedSpace& space) { watched = &space; }

QueryWatch::OfThread::~OfThread() { watched = nullptr; }

}  // namespace echopath
