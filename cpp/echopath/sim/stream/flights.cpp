#include "echopath/sim/stream/flights.h"

#include <algorithm>

#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kEchoesInFlight = 1 << 18;  // paths x channels; as many are handed over meanwhile
constexpr int64_t kNodesOfAPath = 16;         // with more nodes per path, fewer echoes are in flight
// The values of a block at its nodes stay in the second-level cache. No power of two: rows of nodes would share the sets of
// the first.
constexpr int64_t kLargestBlock = 1000;

// Echoes with nodes in every chirp are replayed few at a time, and the next take over their memory: a page that is touched
// for the first time costs as much as a path does at all its nodes.
constexpr int64_t kNodesOfChirps = 128;
constexpr int64_t kValuesInFlight = 150000;  // no power of two, as above
constexpr int64_t kMinBlock = 64;            // fills the registers with vectors of joined echoes

constexpr int64_t kBlocksOfChirps = 16;  // in flight: 32, with their tiles, left the cache that all cores share

// Each block costs a little for each channel, whatever the number of its paths: where there are many channels, fewer blocks
// are in flight, with more paths.
constexpr int64_t kPathsOfABlock = 256;
constexpr int64_t kFewestBlocks = 8;

// Returns a divisor of kMostBlocksOfFlight.
int64_t blocks_in_flight(const PathsInFlight& list) {
  int64_t blocks = list.num_rows > kNodesOfChirps ? kBlocksOfChirps : kMostBlocksOfFlight;
  while (blocks > kFewestBlocks && blocks * list.num_channels * kPathsOfABlock > kEchoesInFlight) blocks /= 2;
  return blocks;
}

// Returns the number of paths that a block has at most.
int64_t largest_block(const PathsInFlight& list) {
  const int64_t values = list.num_channels * num_chunks(list.num_rows, kNodesOfAPath), blocks = blocks_in_flight(list);
  const int64_t most = std::clamp<int64_t>(kEchoesInFlight / (blocks * values), 1, kLargestBlock);
  if (list.num_rows <= kNodesOfChirps) return most;
  return std::min(most, std::max(kMinBlock, kValuesInFlight / (blocks * list.num_channels * list.num_rows)));
}

}  // namespace

std::vector<Flight> plan_flights(std::span<const PathsInFlight> lists) {
  std::vector<Flight> flights;
  int64_t room = 0;  // in units of the smallest share of a flight that a block may take
  for (size_t i = 0; i < lists.size(); ++i) {
    const int64_t size = largest_block(lists[i]), of_block = kMostBlocksOfFlight / blocks_in_flight(lists[i]);
    for (int64_t begin = 0; begin < lists[i].num_paths; begin += size) {
      if (room < of_block) {
        flights.emplace_back();
        room = kMostBlocksOfFlight;
      }
      flights.back().push_back({i, begin, std::min(begin + size, lists[i].num_paths)});
      room -= of_block;
    }
  }
  return flights;
}

}  // namespace echopath
