#include "echopath/bench/replay_only.h"

#include <algorithm>

#include "echopath/base/threads/parallel.h"
#include "echopath/signal/echoes/echo_states.h"

namespace echopath {
namespace {

// Evaluates echoes [begin, end) at all chirps: few echoes at a time, whose nodes stay in the first-level cache.
void evaluate_chirps(const Echoes& echoes, int64_t begin, int64_t end, int num_chirps) {
  constexpr int kChirpsAtOnce = 4;
  EchoStates states[kChirpsAtOnce];
  for (int chirp = 0; chirp < num_chirps; chirp += kChirpsAtOnce) {
    evaluate_states(echoes, chirp, std::min(kChirpsAtOnce, num_chirps - chirp), begin, static_cast<int>(end - begin),
                    states);
  }
}

}  // namespace

int64_t replay_only(const Paths& paths, const Radar& radar, const ReplaySettings& settings, Job* job) {
  constexpr int64_t kEchoes = EchoStates::kCapacity / 4;
  ReplayStream stream(paths, radar, settings, job);
  stream.join({});
  int64_t path_chirps = 0;
  stream.run([&](int, std::span<Echoes> blocks, const ReplayStream::EchoPaths& of) {
    const int num_chirps = blocks.front().sampling.is_static() ? 1 : radar.waveform.num_chirps;
    path_chirps += of.count * num_chirps;
    for (const Echoes& echoes : blocks) {
      parallel_for_chunks(echoes.num_echoes, kEchoes,
                          [&](int64_t begin, int64_t end) { evaluate_chirps(echoes, begin, end, num_chirps); });
    }
  });
  return path_chirps;
}

}  // namespace echopath
