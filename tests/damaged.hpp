// Texts with a few faults in them, for tests of readers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace carom::tests {

/// A small generator, so that the cases are the same everywhere.
class Cases {
 public:
  explicit Cases(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t n) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>(state_ >> 33) % n;
  }

 private:
  std::uint64_t state_;
};

/// One to three times: characters erased or changed, a piece put in, or what `change(text, at)`
/// does.
template <class Change>
std::string damaged(std::string text, Cases& cases, std::span<const std::string> pieces,
                    const Change& change) {
  for (std::size_t k = cases.below(3) + 1; k > 0 && !text.empty(); --k) {
    const std::size_t at = cases.below(text.size());
    switch (cases.below(4)) {
      case 0:
        text.erase(at, cases.below(12) + 1);
        break;
      case 1:
        text.insert(at, pieces[cases.below(pieces.size())]);
        break;
      case 2:
        change(text, at);
        break;
      default:
        text[at] = static_cast<char>(32 + cases.below(95));
    }
  }
  return text;
}

}  // namespace carom::tests
