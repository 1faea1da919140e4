// SPDX-License-Identifier: MIT
// Settings of techniques. A settings struct names each of its rows once, in
//   template <typename Row> void rows(Row& row) { row.number("pcf", pcf, 1, 9, "taps", "tests a
//   map"); ... }
// and its member initialisers are the defaults. Checks, --help, `penumbra techniques`, the README's
// table and the EXR header all come from these rows.
#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "runtime/error.h"

namespace penumbra {

/// One row of a settings table, for people.
struct SettingRow {
    std::string name, kind, fallback, lowest, highest, unit, meaning;
    std::vector<std::string> choices;  ///< kind enum
    bool reachesDevice = false;
};

/// What the user set: "technique.setting" -> value.
using SettingValues = std::map<std::string, std::string>;

/// Visitor that describes rows.
class DescribeRows {
  public:
    void number(const char* name, int& value, int low, int high, const char* unit,
                const char* meaning, bool device = true) {
        rows.push_back({name,
                        "int",
                        fmt::format("{}", value),
                        fmt::format("{}", low),
                        fmt::format("{}", high),
                        unit,
                        meaning,
                        {},
                        device});
    }
    void number(const char* name, float& value, float low, float high, const char* unit,
                const char* meaning, bool device = true) {
        rows.push_back({name,
                        "float",
                        fmt::format("{}", value),
                        fmt::format("{}", low),
                        fmt::format("{}", high),
                        unit,
                        meaning,
                        {},
                        device});
    }
    void flag(const char* name, bool& value, const char* meaning, bool device = true) {
        rows.push_back({name, "bool", value ? "true" : "false", "", "", "", meaning, {}, device});
    }
    void oneOf(const char* name, int& value, const std::vector<int>& allowed, const char* unit,
               const char* meaning, bool device = true) {
        std::vector<std::string> choices;
        choices.reserve(allowed.size());
        for (const int number : allowed) choices.push_back(std::to_string(number));
        rows.push_back({name, "enum", std::to_string(value), "", "", unit, meaning,
                        std::move(choices), device});
    }
    template <typename Enum>
    void choice(const char* name, Enum& value, std::vector<std::string> choices,
                const char* meaning, bool device = true) {
        const auto fallback = choices[static_cast<std::size_t>(value)];
        rows.push_back({name, "enum", fallback, "", "", "", meaning, std::move(choices), device});
    }
    std::vector<SettingRow> rows;
};

/// Visitor that sets rows from text and checks them.
class ApplyRows {
  public:
    ApplyRows(std::string technique, const SettingValues& values)
        : technique_(std::move(technique)), values_(values) {}

    void number(const char* name, int& value, int low, int high, const char* unit, const char*,
                bool = true) {
        parse(name, value, low, high, unit);
    }
    void number(const char* name, float& value, float low, float high, const char* unit,
                const char*, bool = true) {
        parse(name, value, low, high, unit);
    }
    void flag(const char* name, bool& value, const char*, bool = true) {
        const auto* text = find(name);
        if (!text) return;
        requireUsage(*text == "true" || *text == "false", "{}.{} = {} is not true or false",
                     technique_, name, *text);
        value = *text == "true";
    }
    void oneOf(const char* name, int& value, const std::vector<int>& allowed, const char*,
               const char*, bool = true) {
        const auto* text = find(name);
        if (!text) return;
        const auto found = std::find_if(allowed.begin(), allowed.end(), [&](int number) {
            return *text == std::to_string(number);
        });
        requireUsage(found != allowed.end(), "{}.{} = {} is not one of {}", technique_, name, *text,
                     fmt::join(allowed, ", "));
        value = *found;
    }
    template <typename Enum>
    void choice(const char* name, Enum& value, const std::vector<std::string>& choices, const char*,
                bool = true) {
        const auto* text = find(name);
        if (!text) return;
        const auto found = std::find(choices.begin(), choices.end(), *text);
        requireUsage(found != choices.end(), "{}.{} = {} is not one of {}", technique_, name, *text,
                     fmt::join(choices, ", "));
        value = static_cast<Enum>(found - choices.begin());
    }
    /// Throws Error (usage) naming a value that no row took.
    void requireAllUsed() const {
        const std::string prefix = technique_ + ".";
        for (const auto& [key, value] : values_)
            requireUsage(
                key.rfind(prefix, 0) != 0 ||
                    std::find(seen_.begin(), seen_.end(), key.substr(prefix.size())) != seen_.end(),
                "{} has no setting '{}'; allowed: {}", technique_,
                key.substr(std::min(prefix.size(), key.size())), fmt::join(seen_, ", "));
    }

  private:
    const std::string* find(const char* name) {
        seen_.emplace_back(name);
        const auto entry = values_.find(technique_ + "." + name);
        return entry == values_.end() ? nullptr : &entry->second;
    }
    template <typename T>
    void parse(const char* name, T& value, T low, T high, const char* unit) {
        const auto* text = find(name);
        if (!text) return;
        T parsed{};
        const auto [end, error] =
            std::from_chars(text->data(), text->data() + text->size(), parsed);
        requireUsage(error == std::errc() && end == text->data() + text->size(),
                     "{}.{} = {} is not a number", technique_, name, *text);
        requireUsage(parsed >= low && parsed <= high, "{}.{} = {} is outside of {} to {} {}",
                     technique_, name, *text, low, high, unit);
        value = parsed;
    }
    std::string technique_;
    const SettingValues& values_;
    std::vector<std::string> seen_;
};

template <typename Settings>
std::vector<SettingRow> describeSettings() {
    Settings defaults;
    DescribeRows describe;
    defaults.rows(describe);
    return describe.rows;
}

template <typename Settings>
Settings parseSettings(const std::string& technique, const SettingValues& values) {
    Settings settings;
    ApplyRows apply(technique, values);
    settings.rows(apply);
    apply.requireAllUsed();
    return settings;
}

/// Throws Error (usage) naming what is wrong with a technique's values.
template <typename Settings>
void checkSettings(const std::string& technique, const SettingValues& values) {
    parseSettings<Settings>(technique, values);
}

/// The rows with the values in force as their `fallback`, for headers and reports.
template <typename Settings>
std::vector<SettingRow> settingsInForce(Settings settings) {
    DescribeRows describe;
    settings.rows(describe);
    return describe.rows;
}

}  // namespace penumbra
