// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/task_arena.h>

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace knead::tools {

/// Values that are made once for all threads and kept while there is room; the oldest go first.
/// @thread-safety any number of threads; those that want a value that is being made wait for it
template <class Key, class Value>
class Memo {
  public:
    explicit Memo(std::size_t capacity) : capacity_(capacity) {}

    template <class Make>
    std::shared_ptr<const Value> get(const Key& key, const Make& make) {
        const std::shared_ptr<Slot> slot = slot_of(key);
        // Isolated: a thread that waits inside of `make` must not take up a task that wants this very value.
        std::call_once(slot->once,
                       [&] { tbb::this_task_arena::isolate([&] { slot->value.emplace(make()); }); });
        return {slot, &*slot->value};
    }

  private:
    struct Slot {
        std::once_flag once;
        std::optional<Value> value;
    };

    std::shared_ptr<Slot> slot_of(const Key& key) {
        const std::lock_guard lock(mutex_);
        const auto [at, is_new] = slots_.try_emplace(key);
        if (!is_new) return at->second;
        std::shared_ptr<Slot> slot = at->second = std::make_shared<Slot>();
        oldest_first_.push_back(key);
        if (oldest_first_.size() > capacity_) {
            slots_.erase(oldest_first_.front());
            oldest_first_.pop_front();
        }
        return slot;
    }

    std::size_t capacity_;
    std::mutex mutex_;
    std::map<Key, std::shared_ptr<Slot>> slots_;
    std::deque<Key> oldest_first_;
};

}  // namespace knead::tools
