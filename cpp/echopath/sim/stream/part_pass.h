#pragma once
// Computes the signals of many groups of paths, a few groups at a time, so that memory does not grow with their number.
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "echopath/sim/cells/band_map.h"
#include "echopath/sim/cells/cell_bounds.h"
#include "echopath/sim/stream/cube_pass.h"
#include "echopath/sim/stream/replay_stream.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// Replays and synthesises groups of paths on request. The method of synthesis is chosen for the whole set of paths, and the
// signals of all groups add up to the whole signal to rounding, with the same bits for any number of threads.
class PartPass {
 public:
  // `group` [P] names the group of each path, below `num_groups`. Paths and radar must outlive it; settings must not ask for
  // keyframes. Raises as CubePass.
  PartPass(const Paths& paths, const Radar& radar, std::vector<uint32_t> group, uint32_t num_groups, CubeSettings settings);
  ~PartPass();

  // Sets whether the signals of later calls are added to the signal of the whole; by default they are. Each group must be
  // added exactly once. The probe of the settings receives the paths whose signals are added.
  void set_adds_up(bool adds_up) { adds_up_ = adds_up; }
  Cube whole(Job* job) const;
  // Fills the probe of the settings. To be called once, after all groups were added.
  void finish_probe(Job* job);

  using Sets = std::vector<std::vector<uint32_t>>;  // groups whose fields add up
  // Returns the power of the signal of each set. Cells at ranges where a set can show no more than `least` W may be 0. With
  // `ranges` [set][R] only those cells are looked at whose range is asked for (1, else 0), and the others may have no power.
  // Only sets of one group have a mean square. Memory is at most group_bytes() for each group, and a few maps of a channel
  // for each thread. Where some of the sets have several groups it keeps all signals, for sets of these groups alone, until
  // there are such sets again. Raises invalid_argument where the ranges do not match the sets and the map.
  using Ranges = std::vector<std::vector<uint8_t>>;
  std::vector<SetPower> powers(const Sets& sets, const MapWindows& window, int zero_pad, double least, Job* job,
                               const Ranges& ranges = {});
  // Returns the signal of each set.
  std::vector<Cube> cubes(const Sets& sets, Job* job);
  // Adds some sets as one to the whole, where that is wanted, and returns bounds of what each can show (CellBounds):
  // [set, R] in W.
  std::vector<double> bounds(const Sets& sets, const MapWindows& window, int zero_pad, Job* job);
  size_t group_bytes() const;

 private:
  struct Sorted;
  Sorted sorted(const Sets& sets, bool apart) const;
  bool is_kept(const std::vector<uint32_t>& set) const { return set.size() == 1 && kept_.contains(set.front()); }
  std::vector<SummedGroups> summed(const Sets& sets, const Sorted& sorted, const Synthesizer& signals) const;
  void forget();
  void keep(const Sets& sets, const Sorted& sorted, Synthesizer signals);
  Synthesizer synthesizer(int num_groups) const;
  void run(const Sorted& sorted, bool as_one, Synthesizer* out, CellBounds* bounds, Job* job);
  SetPower power_of(const SummedGroups& of, const MapTransform& map, std::span<const uint8_t> asked) const;

  const Paths& paths_;
  const Radar& radar_;
  std::vector<uint32_t> group_;
  uint32_t num_groups_;
  CubeSettings settings_;
  ReplayStream stream_;
  std::optional<PassProbe> probe_;
  bool adds_up_ = true;
  Synthesizer whole_;
  std::optional<const Synthesizer> kept_signals_;
  std::unordered_map<uint32_t, SummedGroups> kept_;  // by group, of these signals
};

}  // namespace echopath
