#pragma once
// Keeps work that must not depend on the number of threads off all threads but one.
#include <functional>

namespace echopath {

// Calls `work` so that TBB's loops in it, those of libraries too, run on one thread. An exception of it is rethrown here.
void run_on_one_thread(const std::function<void()>& work);

}  // namespace echopath
