#include "client/cli/affine_steps.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "client/base/error.h"
#include "client/cli/number_parsers.h"

namespace affskel::client {
namespace {

[[noreturn]] void refuse(const AffineStep& step, const std::string& expected) {
  throw ClientError(ExitCode::kUsage, step.option + ": expected " + expected + ", not '" + step.value + "'");
}

std::vector<double> numbers_of(const AffineStep& step, std::vector<std::size_t> counts,
                               const std::string& expected) {
  const std::optional<std::vector<double>> numbers = parse_numbers(step.value);
  if (!numbers || std::find(counts.begin(), counts.end(), numbers->size()) == counts.end()) {
    refuse(step, expected);
  }
  return *numbers;
}

std::optional<int> axis_of(char letter) {
  return letter >= 'x' && letter <= 'z' ? std::optional(letter - 'x') : std::nullopt;
}

core::AffineMap matrix_step(const AffineStep& step) {
  const std::vector<double> a =
      numbers_of(step, {9, 12}, "9 numbers, the matrix row by row, or 12, every row followed by its shift");
  const std::size_t width = a.size() / 3;
  core::AffineMap map;
  for (std::size_t i = 0; i < 3; ++i) {
    map.rows[i] = {a[i * width], a[i * width + 1], a[i * width + 2]};
  }
  if (width == 4) map.shift = {a[3], a[7], a[11]};
  return map;
}

core::AffineMap rotation_step(const AffineStep& step) {
  const std::string_view text = step.value;
  const std::optional<int> axis = text.size() > 2 && text[1] == ':' ? axis_of(text[0]) : std::nullopt;
  const std::optional<double> degrees = axis ? parse_number(text.substr(2)) : std::nullopt;
  if (!degrees) refuse(step, "an axis and degrees, as in z:30");
  return core::rotation(*axis, *degrees);
}

// "yz:0.5"
std::optional<core::AffineMap> short_shear(std::string_view text) {
  if (text.size() < 4 || text[2] != ':') return std::nullopt;
  const std::optional<int> to = axis_of(text[0]), from = axis_of(text[1]);
  const std::optional<double> factor = parse_number(text.substr(3));
  if (!to || !from || !factor || *to == *from) return std::nullopt;
  return core::shear(*to, *from, *factor);
}

// "y+=z", "y+=0.5z", "y+=0.5*z"
std::optional<core::AffineMap> assigned_shear(std::string_view text) {
  if (text.size() < 4 || text.substr(1, 2) != "+=") return std::nullopt;
  const std::optional<int> to = axis_of(text.front()), from = axis_of(text.back());
  std::string_view number = text.substr(3, text.size() - 4);
  if (number.ends_with('*')) number.remove_suffix(1);
  const std::optional<double> factor = text.size() == 4 ? std::optional(1.0) : parse_number(number);
  if (!to || !from || !factor || *to == *from) return std::nullopt;
  return core::shear(*to, *from, *factor);
}

core::AffineMap shear_step(const AffineStep& step) {
  std::string text = step.value;
  std::erase(text, ' ');
  std::optional<core::AffineMap> map = short_shear(text);
  if (!map) map = assigned_shear(text);
  if (!map) refuse(step, "two axes and a factor, as in y+=z, y+=0.5z or yz:0.5");
  return *map;
}

// The options, in the order of the help.
struct StepOption {
  const char* name;
  const char* description;
  const char* value;
};

constexpr std::array<StepOption, 5> kStepOptions = {
    {{"--matrix", "9 numbers row by row, or 12 with the shift at the end of every row", "A11,A12,..."},
     {"--scale", "One factor or three", "S[,S,S]"},
     {"--rotate", "Axis and degrees, as z:30; counter-clockwise seen from the axis' tip", "ROTATION"},
     {"--translate", "Shift", "X,Y,Z"},
     {"--shear", "As y+=z, y+=0.5z or yz:0.5", "SHEAR"}}};

}  // namespace

void AffineStepOptions::add_to(CLI::App* command) {
  command_ = command;
  for (std::size_t i = 0; i < kStepOptions.size(); ++i) {
    // One value per mention, so that the order of the steps can be told.
    command->add_option(kStepOptions[i].name, values_[i], kStepOptions[i].description)
        ->type_size(1)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name(kStepOptions[i].value);
  }
}

std::vector<AffineStep> AffineStepOptions::in_order() const {
  std::vector<AffineStep> steps;
  std::map<const CLI::Option*, std::size_t> used;
  for (const CLI::Option* option : command_->parse_order()) {
    const std::string name = option->get_name();
    const bool is_step = std::any_of(kStepOptions.begin(), kStepOptions.end(),
                                     [&](const StepOption& step) { return name == step.name; });
    if (is_step) steps.push_back({name, option->results().at(used[option]++)});
  }
  return steps;
}

core::AffineMap affine_step(const AffineStep& step) {
  if (step.option == "--matrix") return matrix_step(step);
  if (step.option == "--rotate") return rotation_step(step);
  if (step.option == "--shear") return shear_step(step);
  if (step.option == "--scale") {
    const std::vector<double> s = numbers_of(step, {1, 3}, "a factor, or three for x,y,z");
    return s.size() == 1 ? core::scaling(s[0], s[0], s[0]) : core::scaling(s[0], s[1], s[2]);
  }
  if (step.option == "--translate") {
    const std::vector<double> t = numbers_of(step, {3}, "x,y,z");
    return core::translation({t[0], t[1], t[2]});
  }
  throw ClientError(ExitCode::kInternal, "no affine step " + step.option);
}

core::AffineMap affine_map_of(const std::vector<AffineStep>& steps) {
  core::AffineMap map;
  for (const AffineStep& step : steps) map = core::then(map, affine_step(step));
  if (core::is_singular(map)) {
    throw ClientError(ExitCode::kUsage, "the map is singular or out of range: it has no inverse");
  }
  return map;
}

}  // namespace affskel::client
