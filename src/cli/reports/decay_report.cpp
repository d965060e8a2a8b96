#include "cli/reports/decay_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "carom/base/elementary.hpp"
#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "io/progress.hpp"

namespace carom::cli {

using io::Json;

namespace {

std::string formula_of(DecayLaw law, bool with_plateau, const char* variable) {
  return fmt::format("P({}) = A ", variable) +
         (law == DecayLaw::exponential ? fmt::format("exp(-kappa {})", variable)
                                       : fmt::format("{}^-a", variable)) +
         (with_plateau ? " + P_infinity" : "");
}

/// The name of a rate, and whether it is one of the window alone.
std::string rate_name(DecayLaw law, bool local) {
  return fmt::format("    {}{}", local ? "local slope: " : "",
                     law == DecayLaw::exponential ? "kappa" : "a");
}

std::string numbers_of(const Decay& decay) {
  std::string text = fmt::format("{} = {}", rate_name(decay.law, decay.local),
                                 with_error(decay.rate, decay.rate_error));
  text += fmt::format(", A = {}", with_error(decay.amplitude, decay.amplitude_error));
  if (decay.with_plateau)
    text += fmt::format(", P_infinity = {}", with_error(decay.plateau, decay.plateau_error));
  return folded(text, "    ");
}

Json json_of(const Decay& decay) {
  Json json = Json::object().set("model", name_of(decay));
  json.set(decay.law == DecayLaw::exponential ? "rate" : "exponent", decay.rate)
      .set("stderr", decay.rate_error)
      .set("local_slope", decay.local)
      .set("amplitude", decay.amplitude)
      .set("amplitude_stderr", decay.amplitude_error);
  if (decay.with_plateau)
    json.set("plateau", decay.plateau).set("plateau_stderr", decay.plateau_error);
  return json.set("p_value", decay.p_value);
}

// A p-value below it says that the law is not that of the data.
constexpr double hardly = 1e-3;

constexpr const char* not_told_apart = "The data do not tell these two laws apart.\n";

}  // namespace

Json decay_json(const DecayFit& fit) {
  if (fit.decays.empty()) return Json::object().set("model", Json()).set("reason", fit.why_none);
  Json json = json_of(fit.decays.front());
  json.set("decided", fit.decided)
      .set("window", Json::array().push(fit.from).push(fit.to))
      .set("escapes", fit.escapes);
  Json others = Json::array();
  for (std::size_t i = 1; i < fit.decays.size(); ++i)
    others.push(json_of(fit.decays[i]).set("odds", odds(fit.decays[i], fit.decays[0])));
  return json.set("alternatives", std::move(others));
}

std::string decay_text(const DecayFit& fit, const char* variable) {
  if (fit.decays.empty())
    return "\n" + folded(fmt::format("No decay was fitted: {}.", fit.why_none)) + "\n";
  std::string text = fmt::format("\nDecay from {} = {:.4g} to {:.4g}, {}\n", variable, fit.from,
                                 fit.to, counted(fit.escapes, "escape"));
  const std::size_t shown = fit.decided ? 1 : 2;
  if (!fit.decided) text += not_told_apart;
  for (std::size_t i = 0; i < shown; ++i) {
    const Decay& decay = fit.decays[i];
    text += fmt::format("  {}\n{}\n    p-value {:.2g}{}\n",
                        formula_of(decay.law, decay.with_plateau, variable), numbers_of(decay),
                        decay.p_value,
                        decay.p_value < hardly ? ": the law does not describe this window" : "");
  }
  if (fit.decays.size() > shown) {
    const double ratio = odds(fit.decays[shown], fit.decays[0]);
    text += fmt::format("  next: {}, {} times as likely\n", name_of(fit.decays[shown]),
                        ratio < 1e-9 ? "less than 1e-9" : fmt::format("{:.2g}", ratio));
  }
  return text;
}

std::string decay_by_hits_text(const DecayFit& fit) {
  if (fit.decays.empty()) return "";
  const Decay& decay = fit.decays.front();
  return fmt::format("By number of hits from n = {:.4g} to {:.4g}{}\n  {}\n{}\n", fit.from, fit.to,
                     fit.decided ? "" : ", not decided",
                     formula_of(decay.law, decay.with_plateau, "n"), numbers_of(decay));
}

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
  // A law that does not describe the window is not told apart from one that does so even less.
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
