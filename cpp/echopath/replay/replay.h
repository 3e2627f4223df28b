#pragma once
// Replay: what the recorded paths look like at other times and to other antennas, without tracing.
//
// Material points (diffuse hits and the physical-optics hit) move with their triangles, exactly; hits on flagged mirrors are
// replayed by images, exactly; other specular hits stay where they were recorded (second-order error in the slide).
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "echopath/replay/amplitude.h"
#include "echopath/replay/frame_nodes.h"

namespace echopath {

struct ReplaySettings {
  double phase_tolerance = 1e-5;  // rad: aim for the interpolated phase, see Replayer::echoes
  bool exact = false;             // evaluate in every chirp instead of interpolating
  bool per_sample = false;        // for signals with the delay of every sample (signal/per_sample.h)
};

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
  // By a Chebyshev polynomial of order 6, 10, 16, 24 or 32 per smooth piece of the frame: the first whose last two coefficients
  // stay below the phase tolerance for all these paths. Nothing where none does, or where it would cost more than `exact`.
  std::optional<std::vector<Echoes>> interpolated(std::span<const int64_t> paths) const;
  // At nodes in every chirp, num_exact_nodes() in all.
  std::vector<Echoes> exact(std::span<const int64_t> paths) const;
  int64_t num_exact_nodes() const;

  // Lengths [channel, P] in m and amplitudes [channel, P] in sqrt(W) at one time. Raises Cancelled when the job is.
  void evaluate(std::span<const int64_t> paths, double time, std::vector<double>& lengths,
                std::vector<std::complex<double>>& amplitudes, Job* job = nullptr) const;

 private:
  struct Block;
  struct Level;
  int exact_order() const;
  const Level& level(int index) const;
  Block localise(std::span<const int64_t> paths) const;
  void add_cell(LocalPath& path, int64_t index, EvaluationScratch& scratch) const;
  void set_flat_cell(LocalPath& path, EvaluationScratch& scratch) const;
  bool evaluate_level(const Block& block, const Level& level, bool check, std::vector<double>& lengths,
                      std::vector<std::complex<double>>& amplitudes) const;
  std::vector<Echoes> by_channel(const Level& level, size_t num_paths, const std::vector<double>& lengths,
                                 const std::vector<std::complex<double>>& amplitudes) const;

  const Paths& paths_;
  const Radar& radar_;
  ReplaySettings settings_;
  RadioConstants radio_;
  std::vector<uint8_t> mesh_moves_;       // by mesh ID
  std::vector<uint8_t> mesh_is_mirror_;   // by mesh ID
  std::vector<std::vector<Vec3>> smooth_normals_;  // by mesh ID, at rest; empty where facets are meant
  std::unique_ptr<const Instant> trace_instant_;
  mutable std::mutex levels_mutex_;
  mutable std::vector<std::unique_ptr<const Level>> levels_;
};

}  // namespace echopath
