#include "cli/reports/validation_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "carom/events/report.hpp"
#include "carom_version.hpp"
#include "cli/common.hpp"
#include "cli/reports/markup.hpp"

namespace carom::cli {

namespace {

using validation::Check;

constexpr const char* page_style = R"(
body { font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; margin: 2em auto; max-width: 92em;
  padding: 0 1em; color: #1b2733; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: .2em .6em; text-align: right; border-bottom: 1px solid #dde3e8; white-space: nowrap; }
th { text-align: left; }
td:first-child, td.source { text-align: left; }
td.source { white-space: normal; min-width: 16em; color: #51606c; }
.passed { color: #12629e; } .failed { color: #b3261e; font-weight: bold; }
svg { vertical-align: middle; }
.wide { overflow-x: auto; }
)";

constexpr const char* pass_colour = "#1f77b4";
constexpr const char* fail_colour = "#b3261e";
constexpr double reach = 5.0;  // of the drawings, in standard errors

std::string ten_digits(double value) { return fmt::format("{:.10g}", value); }

std::string signed_text(double value) { return value == 0.0 ? "0" : fmt::format("{:+.2g}", value); }

double combined_error(const Check& c) {
  return std::sqrt(c.error * c.error + c.expected_error * c.expected_error);
}

bool has_sigma(const Check& c) { return combined_error(c) > 0.0; }

const char* colour_of(const Check& c) { return c.passed ? pass_colour : fail_colour; }

std::string rectangle(double x, double y, double width, double height, const char* fill) {
  return fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"/>)", x,
                     y, width, height, fill);
}

std::string line(double x1, double y1, double x2, double y2, const char* stroke) {
  return fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}"/>)", x1,
                     y1, x2, y2, stroke);
}

constexpr const char* outer_band = "#e8eff5";  // 3 standard errors
constexpr const char* inner_band = "#c9dcec";  // 1 standard error

/// A distance beyond the drawing stands at its edge.
double clamped(double sigma) { return std::clamp(sigma, -reach, reach); }

/// The distance of one case, and how far a known bias lets it be.
std::string strip(const Validation::Done& row) {
  constexpr double width = 160.0, height = 16.0, unit = width / (2.0 * reach);
  const double middle = width / 2.0, error = combined_error(row.check);
  std::string svg =
      fmt::format(R"(<svg width="{0}" height="{1}" viewBox="0 0 {0} {1}">)", width, height);
  svg += rectangle(middle - 3 * unit, 0, 6 * unit, height, outer_band);
  svg += rectangle(middle - unit, 0, 2 * unit, height, inner_band);
  const double low = clamped(-4.0 - row.of.allowance.below / error),
               high = clamped(4.0 + row.of.allowance.above / error);
  svg += line(middle + low * unit, height / 2, middle + high * unit, height / 2, "#8a9aa8");
  svg += line(middle, 0, middle, height, "#51606c");
  return svg + fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4" fill="{}"/></svg>)",
                           middle + clamped(row.check.distance) * unit, height / 2,
                           colour_of(row.check));
}

/// All distances side by side, in the order of the table.
std::string picture(const Validation& all) {
  constexpr double left = 40.0, top = 10.0, unit = 22.0, apart = 13.0;
  std::vector<const Check*> shown_cases;
  for (const Validation::Done& row : all.cases)
    if (has_sigma(row.check)) shown_cases.push_back(&row.check);
  const double width = apart * static_cast<double>(shown_cases.size() + 1),
               height = 2.0 * reach * unit, middle = top + height / 2.0;
  std::string svg = fmt::format(
      R"(<svg width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}" font-size="12" role="img">)",
      left + width + 10.0, top + height + 30.0);
  svg += "<title>Distances of all cases in standard errors</title>";
  svg += rectangle(left, middle - 3 * unit, width, 6 * unit, outer_band);
  svg += rectangle(left, middle - unit, width, 2 * unit, inner_band);
  for (const int sigma : {-4, -3, -1, 0, 1, 3, 4}) {
    const double y = middle - sigma * unit;
    svg += fmt::format(R"(<text x="{:.0f}" y="{:.1f}" text-anchor="end">{}</text>)", left - 8.0,
                       y + 4.0, signed_text(sigma));
    svg += line(left, y, left + width, y,
                sigma == 0             ? "#51606c"
                : std::abs(sigma) == 4 ? "#d8a09c"
                                       : "#ffffff");
  }
  double x = left;
  for (const Check* c : shown_cases) {
    x += apart;
    svg += fmt::format(
        R"(<circle cx="{:.1f}" cy="{:.1f}" r="4.5" fill="{}"><title>{}, seed {}: {:+.2f}</title></circle>)",
        x, middle - clamped(c->distance) * unit, colour_of(*c), escaped(c->name), c->seed,
        c->distance);
  }
  return svg +
         fmt::format(
             R"(<text x="{:.0f}" y="{:.0f}">the cases, in the order of the table</text></svg>)",
             left, top + height + 20.0);
}

std::string table_row(const Validation::Done& row) {
  const Check& c = row.check;
  std::string text = fmt::format("<tr><td>{}</td><td>{}</td>", escaped(c.name), c.seed);
  text += fmt::format("<td>{}</td><td>{}</td>", ten_digits(c.value),
                      c.error > 0.0 ? fmt::format("{:.2g}", c.error) : "");
  text += fmt::format("<td>{}{}</td>", ten_digits(c.expected),
                      c.expected_error > 0.0 ? fmt::format(" ± {:.2g}", c.expected_error) : "");
  text += has_sigma(c) ? fmt::format("<td>{:+.2f} σ</td><td>{}</td>", c.distance, strip(row))
                       : fmt::format("<td>{}</td><td></td>", signed_text(c.distance));
  text +=
      fmt::format(R"(<td class="{}">{}</td><td>{}</td><td>{:.2f}</td><td class="source">{}</td>)",
                  c.passed ? "passed" : "failed", c.passed ? "passed" : "FAILED", grouped(c.hits),
                  c.seconds, escaped(c.source));
  if (!c.report.empty())
    text += fmt::format("</tr><tr><td colspan=\"11\" class=\"failed\">{}</td>",
                        escaped(std::string(shown(c.report))));
  return text + "</tr>\n";
}

}  // namespace

std::string validation_page(const Validation& all, const std::string& command) {
  int threads = 1;
  double seconds = 0.0, cpu_seconds = 0.0;
  for (const Validation::Done& row : all.cases) {
    threads = std::max(threads, row.check.threads);
    seconds += row.check.seconds;
    cpu_seconds += row.check.cpu_seconds;
  }
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<title>Carom: validation</title>\n<style>";
  page += std::string(page_style) + "</style></head><body>\n<h1>Validation of Carom " + version +
          "</h1>\n";
  page += fmt::format(R"(<p><b class="{}">{} passed, {} failed{}.</b> <code>{}</code>, )",
                      all.failed() > 0 ? "failed" : "passed", all.passed(), all.failed(),
                      all.complete ? "" : ", interrupted", escaped(command));
  page += fmt::format("{}, {:.1f} s ({:.1f} s of CPU time).</p>\n",
                      counted(static_cast<std::uint64_t>(threads), "thread"), seconds, cpu_seconds);
  page +=
      "<p>Each case computes a number whose value is known: from a formula, from a paper, or from "
      "an "
      "independent simulation. The distance is the difference in units of its standard error, and "
      "in "
      "the same unit as the value where there is none. A case passes within four standard errors, "
      "and beyond them by the bias that a finite time or length is known to leave (grey lines of "
      "the "
      "table). The bands are one and three standard errors: of independent cases without bias 68 % "
      "and 99.7 % lie in them.</p>\n";
  page += "<h2>Distances</h2>\n<div class=\"wide\">" + picture(all) + "</div>\n";
  page +=
      "<h2>Cases</h2>\n<div class=\"wide\"><table>\n<tr><th>case</th><th>seed</th><th>value</th>"
      "<th>error</th><th>expected</th><th>distance</th><th>−5 … 5 σ</th><th></th><th>hits</th>"
      "<th>s</th><th>the expected value</th></tr>\n";
  for (const Validation::Done& row : all.cases) page += table_row(row);
  return page + "</table></div>\n</body></html>\n";
}

}  // namespace carom::cli
