// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace marey {

/// Runs `work(i)` for all i below `count` on at most `threads` threads (0: one per core
/// of the machine), lowest i first, and waits for all. Each i is a separate job: the
/// results depend on no order. An exception of a job is thrown again here once all have
/// ended: the one of the lowest i if several jobs throw.
template <class Work>
void in_parallel(std::size_t count, std::size_t threads, const Work& work) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> thrown(count);
  {
    std::vector<std::jthread> workers;
    for (std::size_t t = 0; t < std::min(threads, count); ++t) {
      workers.emplace_back([&] {
        for (std::size_t i = next++; i < count; i = next++) {
          try {
            work(i);
          } catch (...) {
            thrown[i] = std::current_exception();
          }
        }
      });
    }
  }
  for (const std::exception_ptr& e : thrown) {
    if (e) std::rethrow_exception(e);
  }
}

}  // namespace marey
