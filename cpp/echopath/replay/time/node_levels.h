#pragma once
// The choices of nodes at which replay evaluates paths, and the scene as posed there.
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "echopath/replay/evaluate/chain_tables.h"
#include "echopath/replay/time/frame_nodes.h"

namespace echopath {

struct ReplaySettings {
  double phase_tolerance = 1e-5;  // rad: aim for the interpolated phase, see Replayer::interpolated
  double amplitude_tolerance = 1e-4;  // likewise, of the interpolated amplitude relative to the largest of the path
  SpecularPoints specular = SpecularPoints::kMaterial;  // where specular hits stand that are not replayed by images
  bool exact = false;             // evaluate in every chirp instead of interpolating
  bool per_sample = false;        // for signals with the delay of every sample (signal/per_sample.h)
};

// Instants of one choice of nodes; made once, used by all blocks.
struct NodeLevel {
  FrameNodes nodes;
  std::vector<Instant> instants;
  NodePoses poses;

  LevelView view() const { return {instants, poses}; }
};

// Levels 1 to num_polynomials() are Chebyshev polynomials per smooth piece of the frame, or per piece between the knots of
// motions, by number of nodes; none that has more than evaluation in every chirp, or where that was asked for. Thread-safe.
class NodeLevels {
 public:
  static constexpr int kHighestOrder = 32;
  // All must outlive it.
  NodeLevels(const Paths& paths, const Radar& radar, const ReplaySettings& settings, const Localiser& localise);

  int num_polynomials() const { return static_cast<int>(shapes_.size()); }
  int64_t num_nodes(int polynomial) const { return shapes_[static_cast<size_t>(polynomial) - 1].num_nodes; }
  int64_t num_exact_nodes() const { return int64_t{radar_.waveform.num_chirps} * exact_order(); }
  ChirpDerivatives derivatives() const { return settings_.per_sample ? ChirpDerivatives::kThird : ChirpDerivatives::kFirst; }

  const NodeLevel& at_trace() const { return level(0); }
  const NodeLevel& polynomial(int index) const { return level(static_cast<size_t>(index)); }
  // Some nodes in each chirp of one transmitter, or one in the middle of each; they know that transmitter alone.
  const NodeLevel& exact(int transmitter) const { return level(exact_level(transmitter)); }
  const NodeLevel& centres(int transmitter) const { return level(centre_level(transmitter)); }
  void forget_chirps(int transmitter) const;
  // One node, at `time` (s).
  NodeLevel single(double time) const;

  // Where to begin with a path, from the motion of the meshes that it touches: 0 where nothing moves, nor does the radar,
  // num_polynomials() + 1 where no polynomial will do.
  int first_level(int64_t path) const;
  // Likewise of paths [begin, begin + levels.size()).
  void first_levels(int64_t begin, std::span<uint8_t> levels) const;
  // The first after `index` of at least that order; where the motions have knots, any that keeps them apart will do.
  int next_polynomial(int index, double needed_order) const;

 private:
  struct Shape {
    int order;                                // nodes per piece
    const std::vector<double>* cuts;          // between pieces, s
    int64_t num_nodes;                        // of all pieces
    double longest;                           // s, of a piece
  };
  void find_shapes();
  int exact_order() const;
  size_t exact_level(int transmitter) const { return 1 + shapes_.size() + static_cast<size_t>(transmitter); }
  size_t centre_level(int transmitter) const { return exact_level(transmitter) + radar_.transmitters.size(); }
  FrameNodes nodes_of(size_t index) const;
  Instant instant(double time) const;
  const NodeLevel& level(size_t index) const;
  std::vector<Instant> instants_of(const FrameNodes& nodes, size_t index) const;
  NodePoses poses_of(const std::vector<Instant>& instants) const;
  // Nodes of a polynomial as it is tried on meshes.
  struct Trial {
    FrameNodes nodes;  // not sampled
    std::vector<Instant> instants;
  };
  const std::vector<int>& mesh_levels() const;
  void find_mesh_levels() const;
  const Trial& trial_of(int polynomial) const;
  bool can_follow(int polynomial, double turn_rate) const;
  bool fits(int polynomial, uint32_t mesh_id) const;

  const Paths& paths_;
  const Radar& radar_;
  ReplaySettings settings_;
  const Localiser& localise_;
  std::vector<double> breakpoints_, knots_;   // s, inside the frame
  std::vector<Shape> shapes_;                 // of levels 1, 2 ...
  mutable std::once_flag mesh_levels_made_;
  mutable std::vector<int> mesh_level_;       // by mesh ID: the first that follows its motion
  mutable std::vector<Trial> tried_;  // by index of the level, which takes over the instants
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<const NodeLevel>> levels_;
};

}  // namespace echopath
