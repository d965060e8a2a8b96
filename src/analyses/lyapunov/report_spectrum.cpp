#include "analyses/lyapunov/report_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "carom/base/elementary.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

using files::Json;

void add_spectrum(Json& json, const System& system, const LyapunovResult& result) {
  if (!result.spectrum.counted()) return;
  if (result.growth.totals().orbits == 0) {
    for (const char* key : {"spectrum", "entropy", "pairing", "zeros"}) json.set(key, Json());
    return;
  }
  const SpectrumEstimate e = estimate_of(result.spectrum);
  const VanishingExponents zeros = vanishing_exponents(system);
  Json exponents = Json::array(), laws = Json::array();
  for (const Estimate& one : e.exponents) exponents.push(estimate_json(one));
  for (const std::string& law : zeros.laws) laws.push(law);
  json.set("spectrum", std::move(exponents));
  json.set("entropy", estimate_json(e.entropy));
  json.set("pairing", e.pairing);
  json.set("zeros", Json::object()
                        .set("count", zeros.count)
                        .set("laws", std::move(laws))
                        .set("largest", e.largest_zero));
}

std::string spectrum_text(const System& system, const LyapunovResult& result,
                          const EnsembleContext& context) {
  if (!result.spectrum.counted() || result.growth.totals().orbits == 0) return {};
  const SpectrumEstimate e = estimate_of(result.spectrum);
  const VanishingExponents zeros = vanishing_exponents(system);
  const std::size_t count = e.exponents.size(), pairs = count / 2;
  std::vector<std::string> numbers, values, others, sums;
  for (std::size_t i = 0; i < std::min<std::size_t>(pairs, context.rows); ++i) {
    const Estimate &one = e.exponents[i], &other = e.exponents[count - 1 - i];
    numbers.push_back(fmt::format("{}", i + 1));
    values.push_back(with_error(one));
    others.push_back(with_error(other));
    sums.push_back(fmt::format("{:.1e}", one.value + other.value));
  }
  std::string text = fmt::format("\nspectrum: {} exponents per unit time, in pairs i and {} - i\n",
                                 count, count + 1) +
                     fitted({{"i", numbers},
                             {"exponent i", values},
                             {fmt::format("exponent {} - i", count + 1), others},
                             {"their sum", sums}}) +
                     rows_text(pairs, context);
  std::string laws;
  for (const std::string& law : zeros.laws) laws += (laws.empty() ? "" : ", ") + law;
  std::string sentence =
      fmt::format("{} of them vanish by conservation laws ({}): the largest of these is {:.1e}",
                  zeros.count, laws, e.largest_zero);
  // They do as 1/t.
  if (const TimeWindow& window = result.growth.window(); window.from > 0.0)
    sentence += fmt::format("; deviations that grow as the time give {:.1e} in this window",
                            elementary::log(window.to / window.from) / (window.to - window.from));
  text += folded(sentence) + '\n';
  return text + fmt::format("Kolmogorov-Sinai entropy, their positive sum = {} per unit time\n",
                            with_error(e.entropy));
}

}  // namespace carom::cli
