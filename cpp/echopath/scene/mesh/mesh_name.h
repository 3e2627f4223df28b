#pragma once
// Names a mesh without keeping it.
#include <memory>

#include "echopath/scene/mesh/mesh.h"

namespace echopath {

// No other mesh has the same name, not even after this one is gone. A name by default is that of no mesh.
class MeshName {
 public:
  MeshName() = default;
  explicit MeshName(const MeshPtr& mesh) : mesh_(mesh) {}
  bool operator==(const MeshName& other) const {
    return !mesh_.owner_before(other.mesh_) && !other.mesh_.owner_before(mesh_);
  }

 private:
  std::weak_ptr<const Mesh> mesh_;
};

}  // namespace echopath
