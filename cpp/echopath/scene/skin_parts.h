#pragma once
// Regions of a skinned mesh as meshes of their own, which can be labelled.
#include "echopath/motion/skin.h"
#include "echopath/scene/readers.h"

namespace echopath {

// Triangles by dominant joint (Skin::dominant_joint): one mesh per joint that has any, by the joint's name, in the order of
// the joints. All are parts of `mesh` and deform by `skin`. Raises invalid_argument unless the skin has the vertices the
// mesh was made from.
std::vector<NamedMesh> parts_by_joint(const MeshPtr& mesh, const Skin& skin);

}  // namespace echopath
