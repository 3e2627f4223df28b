#include "echopath/power/interval/outlines.h"

#include <array>
#include <cmath>

#include "echopath/scene/mesh/adjacency.h"

namespace echopath {
namespace {

constexpr double kOutline = 0.6;

std::vector<uint32_t> pieces_of(const std::vector<std::array<uint32_t, 3>>& neighbours) {
  constexpr uint32_t kNone = 0xFFFFFFFFu;
  std::vector<uint32_t> piece_of(neighbours.size(), kNone), open;
  uint32_t num_pieces = 0;
  for (uint32_t first = 0; first < neighbours.size(); ++first) {
    if (piece_of[first] != kNone) continue;
    piece_of[first] = num_pieces;
    open.push_back(first);
    while (!open.empty()) {
      const uint32_t triangle = open.back();
      open.pop_back();
      for (const uint32_t next : neighbours[triangle]) {
        if (next == kNoTriangle || piece_of[next] != kNone) continue;
        piece_of[next] = num_pieces;
        open.push_back(next);
      }
    }
    ++num_pieces;
  }
  return piece_of;
}

}  // namespace

uint32_t MeshPieces::of(uint32_t mesh_id, uint32_t triangle_id) {
  std::vector<uint32_t>& found = found_[mesh_id];
  if (found.empty()) found = pieces_of(scene_.node_of(mesh_id).mesh->neighbours());
  return found[triangle_id];
}

void Outlines::add(uint32_t mesh_id, uint32_t piece, double power) {
  Sums& sums = pieces_[uint64_t{mesh_id} << 32 | piece];
  sums.power += power;
  sums.squares += power * power;
}

double Outlines::variance() const {
  double sum = 0.0;
  for (const auto& [piece, sums] : pieces_) {
    if (sums.squares == 0.0) continue;
    const double num_hits = sums.power * sums.power / sums.squares;
    sum += sums.squares / (1.0 + (std::sqrt(num_hits) - 1.0) / (kOutline * kOutline));
  }
  return sum;
}

}  // namespace echopath
