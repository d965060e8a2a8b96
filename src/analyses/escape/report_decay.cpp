#include "analyses/escape/report_decay.hpp"

#include <fmt/format.h>

#include "cli/common.hpp"
#include "cli/reports/aligned.hpp"
#include "files/progress.hpp"

namespace carom::cli {

using files::Json;

namespace {

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

}  // namespace

std::string formula_of(DecayLaw law, bool with_plateau, const char* variable) {
  return fmt::format("P({}) = A ", variable) +
         (law == DecayLaw::exponential ? fmt::format("exp(-kappa {})", variable)
                                       : fmt::format("{}^-a", variable)) +
         (with_plateau ? " + P_infinity" : "");
}

std::string rate_name(DecayLaw law, bool local) {
  return fmt::format("    {}{}", local ? "local slope: " : "",
                     law == DecayLaw::exponential ? "kappa" : "a");
}

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

std::string decay_text(const DecayFit& fit) {
  if (fit.decays.empty())
    return "\n" + folded(fmt::format("No decay was fitted: {}.", fit.why_none)) + "\n";
  std::string text = fmt::format("\nDecay from t = {:.4g} to {:.4g}, {}\n", fit.from, fit.to,
                                 counted(fit.escapes, "escape"));
  const std::size_t shown = fit.decided ? 1 : 2;
  if (!fit.decided) text += not_told_apart;
  for (std::size_t i = 0; i < shown; ++i) {
    const Decay& decay = fit.decays[i];
    text += fmt::format("  {}\n{}\n    p-value {:.2g}{}\n",
                        formula_of(decay.law, decay.with_plateau, "t"), numbers_of(decay),
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

}  // namespace carom::cli
