#include "cli/reports/aligned.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace carom::cli {

namespace {

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

int exponent_of(double x) { return static_cast<int>(std::floor(std::log10(std::fabs(x)))); }

}  // namespace

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string Rounding::operator()(double x) const {
  if (std::isnan(x)) return "-";
  if (x == 0.0 || std::isinf(x)) return fmt::format("{}", x);
  if (!scientific) return fmt::format("{:.{}f}", x, std::max(decimals, 0));
  return fmt::format("{:.{}e}", x, std::clamp(exponent_of(x) + decimals, 0, 16));
}

Rounding rounding_of(double size, double spread) {
  size = std::fabs(size);
  const bool known = spread > 0.0 && std::isfinite(spread);
  const bool sized = size > 0.0 && std::isfinite(size);
  Rounding rounding;
  rounding.scientific = sized && (size < 1e-3 || size >= 1e6);
  rounding.decimals = known ? 1 - exponent_of(spread) : sized ? 5 - exponent_of(size) : 0;
  constexpr int most_digits = 10;
  if (sized) rounding.decimals = std::min(rounding.decimals, most_digits - 1 - exponent_of(size));
  if (!rounding.scientific) rounding.decimals = std::clamp(rounding.decimals, 0, 15);
  return rounding;
}

std::string with_error(double value, double error) {
  if (std::isnan(value)) return "-";
  if (!(error > 0.0) || !std::isfinite(error)) return fmt::format("{:.6g}", value);
  const Rounding rounded = rounding_of(std::max(std::fabs(value), error), error);
  constexpr double small = 1e-6;  // has a row of zeros without an exponent, or is cut
  return rounded(value) + " +- " + (error < small ? fmt::format("{:.1e}", error) : rounded(error));
}

std::string in_percent(double share, int digits) {
  const std::string text = fmt::format("{:.{}g}", 100.0 * share, digits);
  return text.find("e+") == std::string::npos ? text : fmt::format("{:.0f}", 100.0 * share);
}

std::vector<std::string> times_text(const std::vector<double>& times) {
  std::vector<std::string> texts;
  for (int digits = 6; digits <= 17; ++digits) {
    texts.clear();
    for (const double t : times) texts.push_back(fmt::format("{:.{}g}", t, digits));
    if (std::set<std::string>(texts.begin(), texts.end()).size() == texts.size()) break;
  }
  return texts;
}

std::string short_duration(double seconds) {
  static constexpr const char* units[] = {"s", "ms", "us", "ns"};
  std::size_t i = 0;
  while (i + 1 < std::size(units) && seconds < 1.0) {
    seconds *= 1000.0;
    ++i;
  }
  return fmt::format("{:.3g} {}", seconds, units[i]);
}

std::string aligned(const std::vector<Column>& columns) {
  std::size_t rows = 0, header_lines = 0;
  std::vector<std::vector<std::string>> headers;
  for (const Column& column : columns) {
    headers.push_back(lines_of(column.header));
    header_lines = std::max(header_lines, headers.back().size());
    rows = std::max(rows, column.cells.size());
  }
  std::vector<std::string> lines(header_lines + rows);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<std::string> cells(header_lines - headers[c].size());
    cells.insert(cells.end(), headers[c].begin(), headers[c].end());
    cells.insert(cells.end(), columns[c].cells.begin(), columns[c].cells.end());
    cells.resize(lines.size());
    std::size_t width = 0;
    for (const std::string& cell : cells) width = std::max(width, characters(cell));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string padding(width - characters(cells[i]), ' ');
      lines[i] += "  " + (columns[c].left ? cells[i] + padding : padding + cells[i]);
    }
  }
  std::string text;
  for (const std::string& line : lines)
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  return text;
}

std::string fitted(const std::vector<Column>& columns) {
  std::string text;
  std::vector<Column> table(columns.begin(), columns.begin() + 1);
  for (auto next = columns.begin() + 1; next != columns.end();) {
    const auto end =
        std::find_if(next + 1, columns.end(), [](const Column& one) { return !one.joined; });
    std::vector<Column> wider = table;
    wider.insert(wider.end(), next, end);
    if (table.size() > 1 && width_of(aligned(wider)) > line_width) {
      text += aligned(table) + '\n';
      table.resize(1);
    } else {
      table = std::move(wider);
      next = end;
    }
  }
  return text + aligned(table);
}

std::vector<std::string> ranges(const std::vector<std::string>& low,
                                const std::vector<std::string>& high) {
  std::size_t low_width = 0, high_width = 0;
  for (const std::string& text : low) low_width = std::max(low_width, text.size());
  for (const std::string& text : high) high_width = std::max(high_width, text.size());
  std::vector<std::string> all;
  for (std::size_t i = 0; i < low.size(); ++i)
    all.push_back(low[i].empty()
                      ? std::string()
                      : fmt::format("{:>{}} .. {:<{}}", low[i], low_width, high[i], high_width));
  return all;
}

std::string folded(const std::string& line, const std::string& indent, std::size_t width) {
  std::string text, rest = line;
  while (characters(rest) > width) {
    std::size_t end = 0;  // of the last word that fits
    for (std::size_t at = rest.find(' ', indent.size() + 1); at != std::string::npos;
         at = rest.find(' ', at + 1)) {
      if (characters(rest.substr(0, at)) > width && end > 0) break;
      end = at;
    }
    if (end == 0) break;
    text += rest.substr(0, end) + '\n';
    rest = indent + rest.substr(end + 1);
  }
  return text + rest;
}

std::size_t width_of(const std::string& text) {
  std::size_t width = 0;
  for (const std::string& line : lines_of(text)) width = std::max(width, characters(line));
  return width;
}

std::vector<std::size_t> every_kth(std::size_t all, std::size_t most) {
  const std::size_t k = most == 0 ? 1 : (all + most - 1) / most;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < all; ++i)
    if ((all - 1 - i) % std::max<std::size_t>(k, 1) == 0) kept.push_back(i);
  return kept;
}

}  // namespace carom::cli
