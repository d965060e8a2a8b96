#include "analyses/splitting/command.hpp"

#include <fmt/format.h>

#include <cmath>

#include "analyses/escape/report_decay.hpp"
#include "carom/base/elementary.hpp"
#include "cli/reports/aligned.hpp"

namespace carom::cli {

using files::Json;

namespace {

std::string name_of(const SplitDecay& decay) {
  return decay.law == DecayLaw::exponential ? "exponential" : "power";
}

Json json_of(const SplitDecay& decay) {
  const Extrapolated& rate = decay.rate;
  return Json::object()
      .set("model", name_of(decay))
      .set(decay.law == DecayLaw::exponential ? "rate" : "exponent", rate.limit.value)
      .set("stderr", rate.limit.error)
      .set("low", rate.low())
      .set("high", rate.high())
      .set("extrapolation", rate.extrapolation)
      .set("local_slope", decay.local)
      .set("amplitude", decay.amplitude)
      .set("amplitude_stderr", decay.amplitude_error)
      .set("p_value", decay.p_value);
}

}  // namespace

Json split_fit_json(const SplitFit& fit) {
  if (fit.decays.empty()) return Json::object().set("model", Json()).set("reason", fit.why_none);
  Json json = json_of(fit.decays.front());
  json.set("decided", fit.decided).set("window", Json::array().push(fit.from).push(fit.to));
  Json others = Json::array();
  for (std::size_t i = 1; i < fit.decays.size(); ++i)
    others.push(json_of(fit.decays[i])
                    .set("odds", elementary::exp(fit.decays[i].evidence - fit.decays[0].evidence)));
  return json.set("alternatives", std::move(others));
}

std::string split_fit_text(const SplitFit& fit, const char* variable) {
  if (fit.decays.empty())
    return "\n" + folded(fmt::format("No decay was fitted: {}.", fit.why_none)) + "\n";
  std::string text =
      fmt::format("\nDecay from {} = {:.6g} to {:.6g}\n", variable, fit.from, fit.to);
  // A law that does not describe the window is not compared with one that does so even less.
  const bool refuted = fit.decays.front().p_value < hardly;
  const std::size_t shown = fit.decided || refuted ? 1 : fit.decays.size();
  if (!fit.decided && !refuted) text += not_told_apart;
  for (std::size_t i = 0; i < shown; ++i) {
    const SplitDecay& decay = fit.decays[i];
    const Extrapolated& rate = decay.rate;
    text += fmt::format("  {}\n{} = {}, extrapolation {:.1e}\n    A = {}",
                        formula_of(decay.law, false, variable), rate_name(decay.law, decay.local),
                        with_error(rate.limit.value, rate.limit.error), rate.extrapolation,
                        with_error(decay.amplitude, decay.amplitude_error));
    if (!std::isnan(decay.p_value))
      text += fmt::format(", p-value {:.2g}{}", decay.p_value,
                          decay.p_value < hardly ? ": the law does not describe this window" : "");
    text += '\n';
  }
  return text;
}

}  // namespace carom::cli
