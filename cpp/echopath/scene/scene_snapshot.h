#pragma once
// Holds a scene that no longer changes, which one stage passes to the next without a copy.
#include <memory>
#include <utility>

#include "echopath/scene/scene.h"

namespace echopath {

// Holds a scene as it was when the snapshot was made. Copies of the snapshot, and the records that keep it, share the scene.
class SceneSnapshot {
 public:
  SceneSnapshot(const Scene& scene) : scene_(std::make_shared<const Scene>(scene)) {}
  SceneSnapshot(Scene&& scene) : scene_(std::make_shared<const Scene>(std::move(scene))) {}
  SceneSnapshot(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)) {}

  const Scene& operator*() const { return *scene_; }
  const Scene* operator->() const { return scene_.get(); }
  const std::shared_ptr<const Scene>& shared() const { return scene_; }

 private:
  std::shared_ptr<const Scene> scene_;
};

}  // namespace echopath
