#pragma once
// Which launch cells lie at the rim of what they see.
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/trace/record/paths.h"

namespace echopath {

// [members] 1: the surface may end within the cell. A cell is surrounded where the cells around it, of the same stratum and batch,
// met the same meshes in the same order, and where each of these surfaces goes on between both hits: without a crease and without a
// step. So nothing there cuts the wave. members: coherent paths by rays; sets: [members] or empty, only members of one set surround
// each other.
std::vector<uint8_t> cells_at_rim(const Paths& paths, std::span<const int64_t> members, std::span<const uint32_t> sets = {});

}  // namespace echopath
