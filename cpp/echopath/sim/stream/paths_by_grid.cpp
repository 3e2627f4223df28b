#include "echopath/sim/stream/paths_by_grid.h"

#include <algorithm>
#include <span>
#include <utility>

#include "echopath/base/memory/large_array.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kPathsOfTask = 1 << 13;  // paths whose grids one task finds

class PathsByGrid {
 public:
  PathsByGrid(const PathGrids& grids, int64_t num_paths, Job* job)
      : num_grids_(static_cast<size_t>(grids.num_grids())), grid_(static_cast<size_t>(num_paths)) {
    const int64_t num_tasks = (num_paths + kPathsOfTask - 1) / kPathsOfTask;
    place_.assign(static_cast<size_t>(num_tasks), std::vector<size_t>(num_grids_));
    parallel_for(num_tasks, [&](int64_t task) {
      if (job) job->throw_if_cancelled();
      find_grids(grids, task);
    });
    std::vector<std::vector<int64_t>> lists = lists_of_counts();
    parallel_for(num_tasks, [&](int64_t task) { fill(task, lists); });
    lists_ = std::move(lists);
  }

  std::vector<std::vector<int64_t>> take() { return std::move(lists_); }

 private:
  std::pair<int64_t, int64_t> range_of(int64_t task) const {
    return {task * kPathsOfTask, std::min<int64_t>((task + 1) * kPathsOfTask, static_cast<int64_t>(grid_.size()))};
  }

  void find_grids(const PathGrids& grids, int64_t task) {
    const auto [begin, end] = range_of(task);
    const std::span<uint8_t> here(grid_.data() + begin, static_cast<size_t>(end - begin));
    grids.first(begin, here);
    for (const uint8_t grid : here) ++place_[static_cast<size_t>(task)][grid];
  }

  // Turns the counts of the tasks into the places where each begins to write.
  std::vector<std::vector<int64_t>> lists_of_counts() {
    std::vector<size_t> sizes(num_grids_);
    for (std::vector<size_t>& places : place_) {
      for (size_t grid = 0; grid < num_grids_; ++grid) sizes[grid] += std::exchange(places[grid], sizes[grid]);
    }
    std::vector<std::vector<int64_t>> lists(num_grids_);
    for (size_t grid = 0; grid < num_grids_; ++grid) resize_large(lists[grid], sizes[grid]);
    return lists;
  }

  void fill(int64_t task, std::vector<std::vector<int64_t>>& lists) {
    const auto [begin, end] = range_of(task);
    std::vector<size_t>& places = place_[static_cast<size_t>(task)];
    for (int64_t path = begin; path < end; ++path) {
      const size_t grid = grid_[static_cast<size_t>(path)];
      lists[grid][places[grid]++] = path;
    }
  }

  size_t num_grids_;
  std::vector<uint8_t> grid_;               // by path
  std::vector<std::vector<size_t>> place_;  // [task][grid]
  std::vector<std::vector<int64_t>> lists_;
};

}  // namespace

std::vector<std::vector<int64_t>> paths_by_grid(const PathGrids& grids, int64_t num_paths, Job* job) {
  return PathsByGrid(grids, num_paths, job).take();
}

}  // namespace echopath
