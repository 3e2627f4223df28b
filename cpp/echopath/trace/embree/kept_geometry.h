#pragma once
// Keeps geometry from one trace of a scene to the next.
#include <memory>
#include <mutex>
#include <utility>

#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

class KeptGeometry;

// Holds the geometry that one trace uses; at its end it returns it to where it was kept, if anywhere.
class GeometryLoan {
 public:
  // Takes the geometry of the scene at the pose, with the origin that EmbreeScene::origin_near gives for `near` (m, world):
  // the kept one after an update, or a new one where `kept` is null or has lent its own to another trace. Raises as
  // EmbreeScene does; nothing is kept then.
  GeometryLoan(KeptGeometry* kept, const Scene& scene, const PosedScene& pose, const Vec3& near, EmbreeScene::Upkeep upkeep,
               Job* job);
  ~GeometryLoan();
  EmbreeScene& operator*() const { return *geometry_; }

 private:
  KeptGeometry* kept_;
  std::unique_ptr<EmbreeScene> geometry_;
};

// Holds the memory of one EmbreeScene between loans. Thread-safe; must outlive its loans.
class KeptGeometry {
 public:
  // Keeps what another use has left over, if anything.
  explicit KeptGeometry(std::unique_ptr<EmbreeScene> geometry = nullptr) : geometry_(std::move(geometry)) {}

 private:
  friend class GeometryLoan;
  std::unique_ptr<EmbreeScene> take();
  void put_back(std::unique_ptr<EmbreeScene> geometry);

  std::mutex mutex_;
  std::unique_ptr<EmbreeScene> geometry_;
};

}  // namespace echopath
