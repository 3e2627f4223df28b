#include "echopath/trace/embree/kept_geometry.h"

#include <utility>

namespace echopath {

GeometryLoan::GeometryLoan(KeptGeometry* kept, const Scene& scene, const PosedScene& pose, const Vec3& near,
                           EmbreeScene::Upkeep upkeep, Job* job)
    : kept_(kept), geometry_(kept ? kept->take() : nullptr) {
  if (!geometry_) geometry_ = std::make_unique<EmbreeScene>();
  geometry_->update(scene, pose, near, upkeep, job);
}

GeometryLoan::~GeometryLoan() {
  if (kept_) kept_->put_back(std::move(geometry_));
}

std::unique_ptr<EmbreeScene> KeptGeometry::take() {
  const std::lock_guard lock(mutex_);
  return std::move(geometry_);
}

void KeptGeometry::put_back(std::unique_ptr<EmbreeScene> geometry) {
  const std::lock_guard lock(mutex_);
  geometry_ = std::move(geometry);
}

}  // namespace echopath
