#include "files/checkpoint/sweep_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "carom/base/error.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/hdf5/sums.hpp"

namespace carom::files {

namespace {

namespace fs = std::filesystem;

std::string plan_of(const std::string& file) { return folder_of(file) + "/sweep"; }
std::string report_of(const std::string& file, std::size_t index) {
  return value_of_sweep(file, index) + ".report";
}

// Whole and on the disk, or not there.
void keep_text(const std::string& path, const std::string& text, const std::string& file) {
  const std::string aside = aside_of(file);
  errno = 0;
  if (!write_new_file(aside, text, true) || std::rename(aside.c_str(), path.c_str()) != 0)
    throw InputError(fmt::format("cannot write '{}': {}", file, std::strerror(errno)));
}

std::optional<std::string> text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return {};
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

[[noreturn]] void refuse(const std::string& name, const std::string& problem) {
  throw InputError(Place{name, 0, 0, ""}, problem, "a sweep as carom wrote it");
}

// A text with its checksum, a line before it. `key` is what it belongs to, and goes into the sum.
std::string summed(const std::string& text, const std::string& key) {
  const std::uint32_t sum = hdf5::crc32(key.data(), key.size());
  return fmt::format("{:08x}\n{}", hdf5::crc32(text.data(), text.size(), sum), text);
}
std::string checked(const std::string& name, const std::string& stored, const std::string& key) {
  const std::size_t end = std::min(stored.find('\n'), stored.size());
  std::string text = stored.substr(std::min(end + 1, stored.size()));
  if (stored != summed(text, key)) refuse(name, "it was changed: its checksum is another");
  return text;
}

// What the report of a value belongs to.
std::string key_of(const SweepPlan& plan, std::size_t index) {
  std::string key = fmt::format("{}\n{}\n", plan.command, index);
  for (const auto& [option, text] : plan.options) key += fmt::format("{} {}\n", option, text);
  return key + plan.systems.at(index);
}

// Of a value's archive, which belongs to its report: "none" where there is none.
std::string sum_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return "none";
  std::vector<char> some(std::size_t{1} << 20);
  std::uint32_t sum = 0;
  while (in.read(some.data(), static_cast<std::streamsize>(some.size())) || in.gcount() > 0)
    sum = hdf5::crc32(some.data(), static_cast<std::size_t>(in.gcount()), sum);
  return fmt::format("{:08x}", sum);
}

Json json_of(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push(text);
  return list;
}

// Parts of a plan; what is missing says that the plan was damaged.
const Json& part(const Json& json, const char* key, const std::string& name) {
  const Json* found = json.find(key);
  if (!found)
    throw InputError(Place{name, 0, 0, key}, "the plan of the sweep is damaged",
                     "a sweep as carom wrote it");
  return *found;
}
std::string text_in(const Json& json, const char* key, const std::string& name) {
  const auto text = part(json, key, name).string();
  return text ? *text : part(Json(), key, name).text();
}
std::vector<std::string> texts_in(const Json& json, const char* key, const std::string& name) {
  const Json& list = part(json, key, name);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < list.size(); ++i) texts.push_back(list[i].string().value_or(""));
  return texts;
}

}  // namespace

std::size_t points_of(const std::vector<SweptKey>& keys) {
  std::size_t points = 1;
  for (const SweptKey& key : keys) points *= key.values.size();
  return points;
}

std::vector<std::string> values_at(const std::vector<SweptKey>& keys, std::size_t index) {
  std::vector<std::string> values(keys.size());
  for (std::size_t k = keys.size(); k-- > 0;) {
    values[k] = keys[k].values[index % keys[k].values.size()];
    index /= keys[k].values.size();
  }
  return values;
}

std::vector<std::string> SweepPlan::at(std::size_t index) const { return values_at(keys, index); }

Json SweepPlan::json() const {
  Json swept = Json::array(), typed = Json::array();
  for (const SweptKey& key : keys)
    swept.push(Json::object().set("key", key.key).set("values", json_of(key.values)));
  for (const auto& [option, text] : options)
    typed.push(Json::object().set("option", option).set("text", text));
  return Json::object()
      .set("command", command)
      .set("name", system_name)
      .set("system", system_toml)
      .set("keys", std::move(swept))
      .set("options", std::move(typed))
      .set("systems", json_of(systems));
}

SweepPlan SweepPlan::of(const Json& json, const std::string& name) {
  SweepPlan plan;
  plan.command = text_in(json, "command", name);
  plan.system_name = text_in(json, "name", name);
  plan.system_toml = text_in(json, "system", name);
  plan.systems = texts_in(json, "systems", name);
  const Json &keys = part(json, "keys", name), &options = part(json, "options", name);
  for (std::size_t i = 0; i < keys.size(); ++i)
    plan.keys.push_back({text_in(keys[i], "key", name), texts_in(keys[i], "values", name)});
  for (std::size_t i = 0; i < options.size(); ++i)
    plan.options.emplace_back(text_in(options[i], "option", name),
                              text_in(options[i], "text", name));
  if (plan.keys.empty() || points_of(plan.keys) != plan.systems.size())
    part(Json(), "systems", name);
  return plan;
}

std::string value_of_sweep(const std::string& file, std::size_t index) {
  return fmt::format("{}/value-{}", folder_of(file), index);
}

void keep_plan(const std::string& file, const SweepPlan& plan) {
  keep_text(plan_of(file), summed(plan.json().text(), ""), file);
}

SweepPlan kept_plan(const std::string& file) {
  const std::string name = plan_of(file);
  return SweepPlan::of(Json::parse(checked(name, text_of(name).value_or(""), ""), name), name);
}

bool has_sweep(const std::string& file) { return has_work_folder(file) && exists(plan_of(file)); }

void keep_report(const std::string& file, const SweepPlan& plan, std::size_t index,
                 const std::string& text) {
  const std::string with_sum =
      fmt::format("archive {}\n{}", sum_of_file(value_of_sweep(file, index)), text);
  keep_text(report_of(file, index), summed(with_sum, key_of(plan, index)), file);
}

void remove_report(const std::string& file, std::size_t index) {
  std::remove(report_of(file, index).c_str());
}

bool has_report(const std::string& file, std::size_t index) {
  return exists(report_of(file, index));
}

std::optional<std::string> kept_report(const std::string& file, const SweepPlan& plan,
                                       std::size_t index) {
  const std::string name = report_of(file, index), archive = value_of_sweep(file, index);
  const std::optional<std::string> stored = text_of(name);
  if (!stored) return {};
  const std::string text = checked(name, *stored, key_of(plan, index));
  const std::string sum = fmt::format("archive {}\n", sum_of_file(archive));
  if (!text.starts_with(sum)) refuse(archive, "it is missing or was changed");
  return text.substr(sum.size());
}

void remove_sweep(const std::string& file) {
  if (!has_work_folder(file)) return;
  std::error_code error;
  fs::remove(plan_of(file), error);
  std::vector<fs::path> values;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(file), error))
    if (entry.path().filename().string().starts_with("value-")) values.push_back(entry.path());
  for (const fs::path& value : values) fs::remove_all(value, error);
}

}  // namespace carom::files
