#pragma once
// Replay: what the recorded paths look like at other times and to other antennas, without tracing.
//
// Material points (diffuse hits and the physical-optics hit) move with their triangles, exactly; hits on flagged mirrors are
// replayed by images, exactly; other specular hits stay where they were recorded (second-order error in the slide) or move with
// the point of reflection by one Newton step (specular_slide.h).
#include <memory>
#include <mutex>
#include <span>

#include "echopath/replay/amplitude.h"
#include "echopath/replay/frame_nodes.h"
#include "echopath/replay/local_paths.h"

namespace echopath {

struct ReplaySettings {
  double phase_tolerance = 1e-5;  // rad: aim for the interpolated phase, see Replayer::interpolated
  double amplitude_tolerance = 1e-4;  // likewise, of the interpolated amplitude relative to the largest of the path
  SpecularPoints specular = SpecularPoints::kMaterial;  // where specular hits stand that are not replayed by images
  bool exact = false;             // evaluate in every chirp instead of interpolating
  bool per_sample = false;        // for signals with the delay of every sample (signal/per_sample.h)
};

// A path that a polynomial did not follow, and the level to go on with.
struct FailedPath {
  int64_t path;
  int next_level;
  bool by_chirp;  // Replayer::by_chirp goes on at that level: lengths do follow its polynomial
};

struct ChannelSpan;

class Replayer {
 public:
  // The radar may differ from the one of the trace in its waveform, antennas and motion. Both must outlive the replayer.
  // Raises invalid_argument when a motion does not cover the frame.
  Replayer(const Paths& paths, const Radar& radar, const ReplaySettings& settings = {});
  ~Replayer();

  int num_channels() const;
  // Nothing on the way of the path moves, nor does the radar.
  bool is_static(int64_t path) const;

  // Echoes of `paths` (indices), by channel [tx * num_rx + rx]; groups are left empty.
  // Of paths that are all static: evaluated once.
  std::vector<Echoes> still(std::span<const int64_t> paths) const;
  // By a Chebyshev polynomial per smooth piece of the frame, or per piece between the knots of motions, of the order of `level`
  // (4 to 32 nodes). A path whose last two coefficients exceed a tolerance, of length or amplitude, has amplitude 0 here and is
  // added to `failed`.
  std::vector<Echoes> interpolated(std::span<const int64_t> paths, int level, std::vector<FailedPath>& failed) const;
  // Levels are 1 to num_levels(), by number of nodes; none that has more than `exact`, or where that was asked for.
  int num_levels() const { return static_cast<int>(shapes_.size()); }
  int64_t num_nodes(int level) const { return num_nodes(shapes_[static_cast<size_t>(level) - 1]); }
  // Where to begin with a path, from the motion of the meshes that it touches; num_levels() + 1 where none will do.
  int first_level(int64_t path) const;
  // Of the channels of one transmitter [rx], at num_exact_nodes() nodes: some in each of its chirps.
  std::vector<Echoes> exact(std::span<const int64_t> paths, int transmitter) const;
  int64_t num_exact_nodes() const;
  // Likewise, at num_nodes_by_chirp() nodes: lengths by the polynomial of `level`, which must follow them, and amplitudes as they
  // are in each chirp. What fades behind an edge of its surface has a root in its amplitude, which no polynomial follows.
  std::vector<Echoes> by_chirp(std::span<const int64_t> paths, int level, int transmitter) const;
  int64_t num_nodes_by_chirp() const;
  // Frees the scene as posed for the chirps of a transmitter.
  void forget_chirps(int transmitter) const;

  // Takes back echoes that are done with, for their memory.
  void recycle(std::span<Echoes> echoes) const;

  // Lengths [channel, P] in m and amplitudes [channel, P] in sqrt(W) at one time. Raises Cancelled when the job is.
  void evaluate(std::span<const int64_t> paths, double time, std::vector<double>& lengths,
                std::vector<std::complex<double>>& amplitudes, Job* job = nullptr) const;

 private:
  struct Level;
  struct Workspace;
  struct LevelShape {
    int order;                                // nodes per piece
    const std::vector<double>* cuts;          // between pieces, s
  };
  int64_t num_nodes(const LevelShape& shape) const;
  void find_shapes();
  FrameNodes nodes_of(size_t index) const;
  int exact_order() const;
  Instant instant(double time) const;
  ChirpDerivatives derivatives() const { return settings_.per_sample ? ChirpDerivatives::kThird : ChirpDerivatives::kFirst; }
  size_t exact_level(int transmitter) const { return 1 + shapes_.size() + static_cast<size_t>(transmitter); }
  size_t centre_level(int transmitter) const { return exact_level(transmitter) + radar_.transmitters.size(); }
  const Level& level(size_t index) const;
  std::unique_ptr<Workspace> take_workspace() const;
  void give_back(std::unique_ptr<Workspace> workspace) const;
  // Of the channels of one transmitter of the level, or of all.
  static constexpr size_t kAll = ~size_t{0};
  std::vector<Echoes> at_nodes(std::span<const int64_t> paths, const Level& level, size_t transmitter = kAll) const;
  void evaluate_one_by_one(std::span<const int64_t> paths, std::span<const size_t> places, std::span<const Instant> instants,
                           const ChannelSpan& channels) const;
  std::vector<Echoes> take_echoes(size_t count) const;
  struct NeededOrder;
  void raise_orders(const FrameNodes& nodes, const Echoes& lengths, std::vector<NeededOrder>& needed) const;
  FailedPath failed(int64_t path, int index, const NeededOrder& needed) const;
  int next_level(int index, double needed_order) const;
  void find_mesh_levels() const;
  bool fits(const Level& level, uint32_t mesh_id) const;

  const Paths& paths_;
  const Radar& radar_;
  ReplaySettings settings_;
  RadioConstants radio_;
  bool antennas_have_phase_ = false;
  std::vector<uint8_t> mesh_moves_;       // by mesh ID
  std::vector<double> breakpoints_, knots_;  // s
  std::vector<LevelShape> shapes_;        // of levels 1, 2 ...
  Localiser localise_;
  mutable std::once_flag mesh_levels_made_;
  mutable std::vector<int> mesh_level_;   // by mesh ID: the first that follows its motion
  mutable std::mutex levels_mutex_;
  mutable std::vector<std::unique_ptr<const Level>> levels_;
  mutable std::mutex workspaces_mutex_;
  mutable std::vector<std::unique_ptr<Workspace>> workspaces_;  // not in use
  mutable std::vector<Echoes> spare_;                           // likewise
};

}  // namespace echopath
