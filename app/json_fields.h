// One description of a struct's fields, used in both directions: a generic `describe(fields, value)` names each field
// with its limits once; FieldReader fills the value from an untrusted JSON object, FieldWriter makes one from it.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "techniques/base/error.h"
#include "techniques/base/types.h"

namespace sightlines {

/// Reads one JSON object. A field that is missing or null keeps what the value holds already.
/// Every failure is an InputError that names the source and the JSON pointer.
class FieldReader {
public:
    FieldReader(const nlohmann::json& object, std::string where, std::string pointer)
        : object_(object), where_(std::move(where)), pointer_(std::move(pointer)) {
        if (!object_.is_object()) fail(pointer_, "is not an object", "write { ... }");
    }

    void boolean(std::string_view name, bool& value) {
        const nlohmann::json* json = find(name);
        if (json == nullptr) return;
        if (!json->is_boolean()) fail(at(name), "is not true or false");
        value = json->get<bool>();
    }

    void text(std::string_view name, std::string& value, std::size_t longest_bytes) {
        const nlohmann::json* json = find(name);
        if (json == nullptr) return;
        if (!json->is_string()) fail(at(name), "is not a text");
        if (json->get_ref<const std::string&>().size() > longest_bytes)
            fail(at(name), "is too long", "at most " + std::to_string(longest_bytes) + " bytes");
        value = json->get<std::string>();
    }

    template <class Number>
    void number(std::string_view name, Number& value, Number lowest, Number highest) {
        if (const nlohmann::json* json = find(name)) value = checked_number(*json, at(name), lowest, highest);
    }

    template <class Number>
    void optional_number(std::string_view name, std::optional<Number>& value, Number lowest, Number highest) {
        if (const nlohmann::json* json = find(name)) value = checked_number(*json, at(name), lowest, highest);
    }

    template <int Length, class Number>
    void vector(std::string_view name, glm::vec<Length, Number>& value, Number lowest, Number highest) {
        const nlohmann::json* json = find(name);
        if (json == nullptr) return;
        if (!json->is_array() || json->size() != static_cast<std::size_t>(Length))
            fail(at(name), "is not a list of " + std::to_string(Length) + " numbers");
        for (int i = 0; i < Length; ++i)
            value[i] = checked_number((*json)[static_cast<std::size_t>(i)], at(name) + "/" + std::to_string(i), lowest,
                                      highest);
    }

    template <int Length, class Number>
    void optional_vector(std::string_view name, std::optional<glm::vec<Length, Number>>& value, Number lowest,
                         Number highest) {
        if (find(name) == nullptr) return;
        glm::vec<Length, Number> read{};
        vector(name, read, lowest, highest);
        value = read;
    }

    /// An enumeration, by the names of its values in order.
    template <class Enum>
    void choice(std::string_view name, Enum& value, std::span<const std::string_view> names) {
        std::string chosen(names[static_cast<std::size_t>(value)]);
        text(name, chosen, 64);
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (names[i] != chosen) continue;
            value = static_cast<Enum>(i);
            return;
        }
        fail_unknown(at(name), "has no choice " + chosen, chosen, names);
    }

    template <class Enum>
    void optional_choice(std::string_view name, std::optional<Enum>& value, std::span<const std::string_view> names) {
        if (find(name) == nullptr) return;
        value.emplace();
        choice(name, *value, names);
    }

    template <class Value, class Describe>
    void object(std::string_view name, Value& value, Describe describe) {
        const nlohmann::json* json = find(name);
        if (json == nullptr) return;
        FieldReader inner(*json, where_, at(name));
        describe(inner, value);
        inner.finish();
    }

    template <class Value, class Describe>
    void optional_object(std::string_view name, std::optional<Value>& value, Describe describe) {
        if (find(name) == nullptr) return;
        value.emplace();
        object(name, *value, describe);
    }

    template <class Value, class Describe>
    void list(std::string_view name, std::vector<Value>& values, std::size_t most, Describe describe) {
        const nlohmann::json* json = find(name);
        if (json == nullptr) return;
        if (!json->is_array()) fail(at(name), "is not a list");
        if (json->size() > most) fail(at(name), "is too long", "at most " + std::to_string(most) + " entries");
        values.assign(json->size(), Value{});
        for (std::size_t i = 0; i < values.size(); ++i) {
            FieldReader inner((*json)[i], where_, at(name) + "/" + std::to_string(i));
            describe(inner, values[i]);
            inner.finish();
        }
    }

    /// The raw JSON of a field that has a form of its own, or null.
    const nlohmann::json* find(std::string_view name) {
        known_.emplace_back(name);
        const auto found = object_.find(std::string(name));
        return found == object_.end() || found->is_null() ? nullptr : &*found;
    }

    /// To be called when all fields are described: refuses keys that none of them has.
    void finish() const {
        for (const auto& [key, unused] : object_.items()) {
            bool described = false;
            for (const std::string& name : known_) described = described || name == key;
            if (!described) fail_unknown(at(key), "is not known", key, known_);
        }
    }

    std::string at(std::string_view name) const {
        std::string escaped;
        for (const char letter : name) escaped += letter == '~' ? "~0" : letter == '/' ? "~1" : std::string(1, letter);
        return pointer_ + "/" + escaped;
    }

    [[noreturn]] void fail(const std::string& pointer, const std::string& problem,
                           const std::string& remedy = {}) const {
        throw InputError(where_, pointer, problem, remedy);
    }

private:
    template <class Names>
    [[noreturn]] void fail_unknown(const std::string& pointer, const std::string& problem, const std::string& wrong,
                                   const Names& names) const {
        const std::string near = nearest_name(wrong, names);
        std::string all;
        for (const auto& name : names) all += (all.empty() ? "" : ", ") + std::string(name);
        fail(pointer, problem, near.empty() ? "there are: " + all : "did you mean " + near + "?");
    }

    template <class Number>
    Number checked_number(const nlohmann::json& json, const std::string& pointer, Number lowest, Number highest) const {
        const auto out_of_range = [&] {
            fail(pointer, json.dump() + " is outside its range",
                 "give " + nlohmann::json(lowest).dump() + " to " + nlohmann::json(highest).dump());
        };
        if (!json.is_number()) fail(pointer, "is not a number");
        if constexpr (std::integral<Number>) {
            if (json.is_number_float()) fail(pointer, json.dump() + " is not a whole number");
            if (json.is_number_unsigned()) {
                const auto number = json.get<std::uint64_t>();
                if (std::cmp_less(number, lowest) || std::cmp_greater(number, highest)) out_of_range();
            } else if (std::cmp_less(json.get<std::int64_t>(), lowest) ||
                       std::cmp_greater(json.get<std::int64_t>(), highest)) {
                out_of_range();
            }
            return json.get<Number>();
        } else {
            const double number = json.get<double>();
            if (!std::isfinite(number) || number < static_cast<double>(lowest) || number > static_cast<double>(highest))
                out_of_range();
            return static_cast<Number>(number);
        }
    }

    const nlohmann::json& object_;
    std::string where_, pointer_;
    std::vector<std::string> known_;
};

/// Makes one JSON object; the same members as FieldReader, so that one description serves both.
class FieldWriter {
public:
    void boolean(std::string_view name, bool value) { json_[std::string(name)] = value; }
    void text(std::string_view name, const std::string& value, std::size_t) { json_[std::string(name)] = value; }

    template <class Number>
    void number(std::string_view name, Number value, Number, Number) {
        json_[std::string(name)] = short_number(value);
    }
    template <class Number>
    void optional_number(std::string_view name, const std::optional<Number>& value, Number, Number) {
        if (value) json_[std::string(name)] = short_number(*value);
    }
    template <int Length, class Number>
    void vector(std::string_view name, const glm::vec<Length, Number>& value, Number, Number) {
        nlohmann::json list = nlohmann::json::array();
        for (int i = 0; i < Length; ++i) list.push_back(short_number(value[i]));
        json_[std::string(name)] = std::move(list);
    }
    template <int Length, class Number>
    void optional_vector(std::string_view name, const std::optional<glm::vec<Length, Number>>& value, Number lowest,
                         Number highest) {
        if (value) vector(name, *value, lowest, highest);
    }
    template <class Enum>
    void choice(std::string_view name, Enum value, std::span<const std::string_view> names) {
        json_[std::string(name)] = names[static_cast<std::size_t>(value)];
    }
    template <class Enum>
    void optional_choice(std::string_view name, const std::optional<Enum>& value,
                         std::span<const std::string_view> names) {
        if (value) choice(name, *value, names);
    }
    template <class Value, class Describe>
    void object(std::string_view name, const Value& value, Describe describe) {
        FieldWriter inner;
        describe(inner, value);
        json_[std::string(name)] = inner.take();
    }
    template <class Value, class Describe>
    void optional_object(std::string_view name, const std::optional<Value>& value, Describe describe) {
        if (value) object(name, *value, describe);
    }
    template <class Value, class Describe>
    void list(std::string_view name, const std::vector<Value>& values, std::size_t, Describe describe) {
        nlohmann::json list = nlohmann::json::array();
        for (const Value& value : values) {
            FieldWriter inner;
            describe(inner, value);
            list.push_back(inner.take());
        }
        json_[std::string(name)] = std::move(list);
    }
    void raw(std::string_view name, nlohmann::json json) { json_[std::string(name)] = std::move(json); }

    nlohmann::json take() { return std::move(json_); }

private:
    /// A float as the shortest decimal number that reads back the same: 0.1, not 0.10000000149011612.
    template <class Number>
    static nlohmann::json short_number(Number value) {
        if constexpr (std::same_as<Number, float>) {
            char text[32];
            const auto written = std::to_chars(text, text + sizeof text, value);
            double shortest = static_cast<double>(value);
            std::from_chars(text, written.ptr, shortest);
            return shortest;
        } else {
            return value;
        }
    }

    nlohmann::json json_ = nlohmann::json::object();
};

}  // namespace sightlines
