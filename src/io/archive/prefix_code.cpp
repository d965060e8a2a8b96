#include "io/archive/prefix_code.hpp"

#include <algorithm>
#include <cstddef>

namespace carom::io::hdf5 {

namespace {

constexpr unsigned deepest = 32;  // or deeper: such words are too long anyway

// How many leaves of Huffman's tree are how deep. `counts` are in rising order. Two queues, of
// leaves and of nodes, each in rising order: the two least are at their fronts.
std::vector<std::uint32_t> depths(const std::vector<std::uint32_t>& counts) {
  const std::size_t leaves = counts.size(), all = 2 * leaves - 1;
  std::vector<std::uint32_t> weight(counts), parent(all), depth(all);
  weight.resize(all);
  std::size_t leaf = 0, node = leaves;
  for (std::size_t made = leaves; made < all; ++made)
    for (int child = 0; child < 2; ++child) {
      const bool is_leaf = leaf < leaves && (node == made || weight[leaf] <= weight[node]);
      const std::size_t least = is_leaf ? leaf++ : node++;
      weight[made] += weight[least];
      parent[least] = static_cast<std::uint32_t>(made);
    }
  std::vector<std::uint32_t> found(deepest + 1);
  for (std::size_t i = all - 1; i-- > 0;) {
    depth[i] = depth[parent[i]] + 1;
    if (i < leaves) ++found[std::min(depth[i], deepest)];
  }
  return found;
}

// Words that are too long get the greatest length allowed. That is more than a code can have: then
// a shorter word is made longer by one, and one of the longest takes the place beside it.
void shorten(std::vector<std::uint32_t>& found, unsigned longest) {
  for (unsigned i = longest + 1; i <= deepest; ++i) found[longest] += found[i], found[i] = 0;
  std::uint64_t taken = 0;
  for (unsigned i = 1; i <= longest; ++i) taken += std::uint64_t{found[i]} << (longest - i);
  for (; taken > std::uint64_t{1} << longest; --taken) {
    unsigned shorter = longest - 1;
    while (found[shorter] == 0) --shorter;
    --found[shorter];
    found[shorter + 1] += 2;
    --found[longest];
  }
}

// Symbols that occur, the rarest first: by the lowest digits of their counts, then by the next
// ones. Comparing them takes three times as long.
std::vector<std::uint32_t> rarest_first(std::span<const std::uint32_t> counts) {
  constexpr std::uint32_t digit_bits = 8, digits = 1u << digit_bits;
  std::vector<std::uint32_t> order, sorted;
  std::uint32_t most = 0;
  order.reserve(counts.size());
  for (std::uint32_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) order.push_back(i);
    most = std::max(most, counts[i]);
  }
  sorted.resize(order.size());
  for (std::uint32_t shift = 0; most >> shift > 0; shift += digit_bits) {
    const auto digit = [&](std::uint32_t symbol) { return counts[symbol] >> shift & (digits - 1); };
    std::uint32_t place[digits + 1] = {};
    for (const std::uint32_t symbol : order) ++place[digit(symbol) + 1];
    for (std::uint32_t i = 0; i < digits; ++i) place[i + 1] += place[i];
    for (const std::uint32_t symbol : order) sorted[place[digit(symbol)]++] = symbol;
    std::swap(order, sorted);
  }
  return order;
}

constexpr std::uint32_t reversed(std::uint32_t word, unsigned length) {
  word = (word & 0x5555u) << 1 | (word >> 1 & 0x5555u);
  word = (word & 0x3333u) << 2 | (word >> 2 & 0x3333u);
  word = (word & 0x0f0fu) << 4 | (word >> 4 & 0x0f0fu);
  word = (word & 0x00ffu) << 8 | (word >> 8 & 0x00ffu);
  return word >> (16 - length);
}

}  // namespace

std::vector<std::uint8_t> code_lengths(std::span<const std::uint32_t> counts, unsigned longest) {
  const std::vector<std::uint32_t> order = rarest_first(counts);
  std::vector<std::uint32_t> rising;
  for (const std::uint32_t symbol : order) rising.push_back(counts[symbol]);
  std::vector<std::uint32_t> found = depths(rising);
  shorten(found, longest);
  std::vector<std::uint8_t> lengths(counts.size());
  std::size_t next = 0;
  for (unsigned length = longest; length > 0; --length)
    for (std::uint32_t i = 0; i < found[length]; ++i)
      lengths[order[next++]] = static_cast<std::uint8_t>(length);
  return lengths;
}

std::vector<Bits> code_words(std::span<const std::uint8_t> lengths) {
  constexpr unsigned longest = 16;
  std::uint32_t next[longest + 2] = {};
  for (const std::uint8_t length : lengths)
    if (length > 0) ++next[length + 1];
  // The first word of a length follows the last one of the length before.
  for (unsigned i = 1; i <= longest; ++i) next[i + 1] = 2 * (next[i + 1] + next[i]);
  std::vector<Bits> words;
  words.reserve(lengths.size());
  for (const std::uint8_t length : lengths)
    words.push_back({length > 0 ? reversed(next[length]++, length) : 0, length});
  return words;
}

}  // namespace carom::io::hdf5
