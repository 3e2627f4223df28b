#include "echopath/base/threads/one_thread.h"

#include <tbb/task_arena.h>

namespace echopath {

#ifdef ECHOPATH_THREAD_SANITIZER
void run_on_one_thread(const std::function<void()>& work) { work(); }  // libraries have no threads there: parallel.cpp
#else
void run_on_one_thread(const std::function<void()>& work) { tbb::task_arena(1).execute(work); }
#endif

}  // namespace echopath
