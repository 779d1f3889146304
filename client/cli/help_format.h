#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace affskel::client {

/// Help with one placeholder per option; possible values and the default stand in the description.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_option_usage(const CLI::Option* positional) const override;
};

/// What an option's value is called, e.g. "FILE"; empty for flags.
std::string placeholder(const CLI::Option& option);

/// The values that one_of() allows, else empty.
std::vector<std::string> possible_values(const CLI::Option& option);

}  // namespace affskel::client
