#include "parts.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "carom/base/error.hpp"

namespace carom::page {

// A line for each column: its name, and its numbers in hexadecimal digits.
Part::Part(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const char* const last = text.data() + end;
    const char* next = std::find(text.data() + at, last, ' ');
    std::vector<std::uint64_t>& bits = columns_[{text.data() + at, next}];
    while (next != last) {
      const auto read = std::from_chars(next + 1, last, bits.emplace_back(), 16);
      if (read.ec != std::errc{}) throw InputError("this is no part of an ensemble");
      next = read.ptr;
    }
    at = end + 1;
  }
}

std::string Part::text() const {
  std::string text;
  for (const auto& [key, bits] : columns_) {
    text += key;
    for (const std::uint64_t one : bits) fmt::format_to(std::back_inserter(text), " {:x}", one);
    text += '\n';
  }
  return text;
}

const std::vector<std::uint64_t>& Part::column(const std::string& key) const {
  const auto found = columns_.find(key);
  if (found == columns_.end())
    throw InputError("the part of an ensemble lacks '" + key + "': it is of another one");
  return found->second;
}

std::vector<std::string> Part::names(const std::string& begin) const {
  std::vector<std::string> names;
  for (const auto& [key, bits] : columns_)
    if (key.starts_with(begin)) names.push_back(key.substr(begin.size()));
  return names;
}

void PartIn::expect(bool fits, const char* problem) const {
  if (!fits)
    throw InputError("the part of an ensemble cannot be added: '" + path_ + "/" + problem + "'");
}

void put_common(Part& part, const EnsembleResult& result) {
  std::vector<std::uint64_t> done;
  for (const TrajectoryRange& range : result.done.ranges()) {
    done.push_back(range.first);
    done.push_back(range.last);
  }
  part.put("done", done);
  part.put<std::uint64_t>("decisions", {result.decisions.filter, result.decisions.exact});
  part.put<double>("seconds", {result.seconds, result.cpu_seconds});
  for (const auto& [index, report] : result.reports)
    part.put(fmt::format("reports/{}", index), std::vector<char>(report.begin(), report.end()));
}

void get_common(const Part& part, EnsembleResult& result) {
  const auto done = part.get<std::uint64_t>("done");
  for (std::size_t i = 0; i + 1 < done.size(); i += 2) result.done.add({done[i], done[i + 1]});
  const auto decisions = part.get<std::uint64_t>("decisions");
  result.decisions = {decisions.at(0), decisions.at(1)};
  const auto seconds = part.get<double>("seconds");
  result.seconds = seconds.at(0);
  result.cpu_seconds = seconds.at(1);
  for (const std::string& index : part.names("reports/")) {
    const auto report = part.get<char>("reports/" + index);
    result.reports.emplace_back(std::stoull(index), std::string(report.begin(), report.end()));
  }
}

}  // namespace carom::page
