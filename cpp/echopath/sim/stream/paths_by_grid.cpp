#include "echopath/sim/stream/paths_by_grid.h"

#include <algorithm>
#include <utility>

#include "echopath/base/memory/large_array.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kPathsOfTask = 1 << 13;  // paths whose grids one task finds, at least
constexpr int64_t kPathsPerGrid = 8;       // of a task, at least, so that the counts of tasks take less memory than paths do

class SortByGrid {
 public:
  // `some` are that many indices of paths; null: these paths are all.
  SortByGrid(const PathGrids& grids, const int64_t* some, int64_t num_paths, Job* job)
      : some_(some), lists_(no_paths_by_grid(grids.grids())),
        paths_of_task_(std::max(kPathsOfTask, kPathsPerGrid * std::ssize(lists_))), grid_(static_cast<size_t>(num_paths)) {
    const int64_t num_tasks = num_chunks(num_paths, paths_of_task_);
    place_.assign(num_tasks, std::vector<size_t>(lists_.size()));
    parallel_for(num_tasks, [&](int64_t task) {
      if (job) job->throw_if_cancelled();
      find_grids(grids, task);
    });
    make_lists();
    parallel_for(num_tasks, [&](int64_t task) { fill(task); });
  }

  PathsByGrid take() { return std::move(lists_); }

 private:
  int64_t path_at(int64_t i) const { return some_ ? some_[i] : i; }

  std::pair<int64_t, int64_t> range_of(int64_t task) const {
    return {task * paths_of_task_, std::min((task + 1) * paths_of_task_, std::ssize(grid_))};
  }

  void find_grids(const PathGrids& grids, int64_t task) {
    const auto [begin, end] = range_of(task);
    for (int64_t i = begin; i < end; ++i) {
      grid_[i] = grids.first(path_at(i));
      ++place_[task][grid_[i].place()];
    }
  }

  // Turns the counts of the tasks into the places where each begins to write.
  void make_lists() {
    for (size_t grid = 0; grid < lists_.size(); ++grid) {
      size_t size = 0;
      for (auto& places : place_) size += std::exchange(places[grid], size);
      resize_large(lists_[grid], size);
    }
  }

  void fill(int64_t task) {
    const auto [begin, end] = range_of(task);
    auto& places = place_[task];
    for (int64_t i = begin; i < end; ++i) {
      const size_t grid = grid_[i].place();
      lists_[grid][places[grid]++] = path_at(i);
    }
  }

  const int64_t* some_;
  PathsByGrid lists_;
  int64_t paths_of_task_;
  std::vector<GridIndex> grid_;             // of one path after the other
  std::vector<std::vector<size_t>> place_;  // [task][grid]
};

}  // namespace

PathsByGrid paths_by_grid(const PathGrids& grids, int64_t num_paths, Job* job) {
  return SortByGrid(grids, nullptr, num_paths, job).take();
}

PathsByGrid paths_by_grid(const PathGrids& grids, std::span<const int64_t> paths, Job* job) {
  return SortByGrid(grids, paths.data(), std::ssize(paths), job).take();
}

}  // namespace echopath
