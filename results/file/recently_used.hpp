#pragma once

#include <algorithm>
#include <list>
#include <utility>

namespace jostle::inline results {

/// The last values that were asked for, by their keys.
template <class Key, class Value, std::size_t most>
class RecentlyUsed {
 public:
  /// The value of a key, made by make() where it is not among the last `most`. Valid until the next
  /// call.
  template <class Make>
  const Value& get(const Key& key, Make&& make) {
    auto found = std::ranges::find(values_, key, &Entry::first);
    if (found == values_.end()) {
      while (values_.size() >= most) values_.pop_back();  // before another takes memory
      values_.emplace_front(key, make());
    } else {
      values_.splice(values_.begin(), values_, found);
    }
    return values_.front().second;
  }

  void clear() { values_.clear(); }

 private:
  using Entry = std::pair<Key, Value>;
  std::list<Entry> values_;
};

}  // namespace jostle::inline results
