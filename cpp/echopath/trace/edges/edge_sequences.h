#pragma once
// Finds the sequences of edges that waves take over flat faces from one edge to the next (em/edges/multiple_diffraction.h).
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "echopath/em/edges/multiple_diffraction.h"
#include "echopath/record/paths.h"
#include "echopath/record/posed_edge.h"

namespace echopath {

// Faces longer than this carry no waves from edge to edge: those that an edge sends over them are 26 dB weaker than its own
// echo, and most faces of a street are longer.
inline constexpr double kLongestFace = 40.0;  // wavelengths

// Holds the edges that a wave has met so far, each with the point that it met.
struct EdgeSequence {
  std::vector<DiffractingEdge> edges;
  std::vector<Hit> hits;  // the points on the edges
};

class EdgeSequences {
 public:
  // The edges must outlive it.
  EdgeSequences(std::span<const PosedEdge> edges, double wavelength);
  // Takes a sequence and the index of its last edge, and returns whether it is to be followed farther.
  using Visit = std::function<bool(const EdgeSequence&, size_t last_edge)>;
  // Calls `visit` for each sequence of two to `most` edges that a wave meets which arrives along the unit vector `in` at a
  // point of an edge (its index). `point` is the hit there.
  void follow(size_t edge, const Hit& point, const Vec3& position, const Vec3& in, int most, const Visit& visit) const;

 private:
  // Describes a face at an edge.
  struct OnPlane {
    size_t edge;
    int face;
    double offset, key;       // m: of its plane; faces on one plane have nearly the same
    Vec3 inward, from, line;  // of the face and of its edge, which are searched again and again
  };
  struct Met {
    size_t edge;
    double along;  // in [0, 1] of its stretch
  };

  std::vector<OnPlane> sorted_faces(const Vec3& middle, double extent) const;
  void find_planes();
  bool find_next(size_t edge, int face, const Vec3& position, const Vec3& direction, Met& met) const;
  void extend(EdgeSequence& sequence, size_t edge, const Vec3& in, int most, const Visit& visit) const;

  std::span<const PosedEdge> edges_;
  double longest_;                            // m
  std::vector<std::vector<OnPlane>> planes_;  // the faces that end at edges and lie on one plane
  std::vector<std::array<size_t, 2>> plane_;  // by edge and face
};

}  // namespace echopath
