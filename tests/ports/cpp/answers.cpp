// Answers cases of the test vectors with the port in fairflight.hpp: a case a line on standard input, an answer a line on standard output.
//
//     g++ -std=c++17 -O2 [-DREAL=float] answers.cpp -o answers
//     harness check-port [--precision binary32] ./answers
//
// Half of this file reads JSON; the standard library of C++ does not.
#include "fairflight.hpp"

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#ifndef REAL
#define REAL double
#endif
using Real = REAL;

// A value of JSON: a number keeps its text, so that integers lose no bit.
struct Json {
    char kind = 'n';  // null, boolean, number, string, array, object
    std::string text;
    std::vector<Json> items;
    std::map<std::string, Json> members;

    const Json& operator[](const std::string& key) const {
        static const Json none;
        const auto found = members.find(key);
        return found == members.end() ? none : found->second;
    }
    const Json& operator[](std::size_t i) const { return items.at(i); }
    bool is_null() const { return kind == 'n'; }
    double number() const { return std::strtod(text.c_str(), nullptr); }
    std::uint64_t integer() const { return std::strtoull(text.c_str(), nullptr, 10); }
    std::vector<Real> numbers() const {
        std::vector<Real> all;
        for (const Json& item : items) all.push_back(Real(item.number()));
        return all;
    }
};

class Reader {
public:
    explicit Reader(const std::string& text) : text(text) {}

    Json value() {
        Json json;
        switch (const char c = peek()) {
            case '{':
                json.kind = 'o';
                each('}', [&] {
                    const std::string key = string();
                    peek();
                    ++at;  // the colon
                    json.members[key] = value();
                });
                return json;
            case '[':
                json.kind = 'a';
                each(']', [&] { json.items.push_back(value()); });
                return json;
            case '"': json.kind = 's'; json.text = string(); return json;
            default:
                while (at < text.size() && std::string(",]} \t").find(text[at]) == std::string::npos) json.text += text[at++];
                if (json.text != "null") json.kind = c == 't' || c == 'f' ? 'b' : '0';
                return json;
        }
    }

private:
    char peek() {
        while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
        if (at == text.size()) throw std::runtime_error("the line ends within a value");
        return text[at];
    }
    template <class Item>
    void each(char end, Item item) {
        for (++at; peek() != end;) {
            item();
            if (peek() == ',') ++at;
        }
        ++at;
    }
    std::string string() {
        peek();
        std::string found;
        for (++at; text.at(at) != '"'; ++at) found += text[at] == '\\' ? text.at(++at) : text[at];
        ++at;
        return found;
    }

    const std::string& text;
    std::size_t at = 0;
};

// The variates of a case. What is drawn beyond them is told by the number of draws.
struct Source {
    const Json& draws;
    bool exponentials_given;
    std::size_t drawn = 0;

    const Json* next() { return drawn++ < draws.items.size() ? &draws[drawn - 1] : nullptr; }
    Real uniform() {
        const Json* draw = next();
        return draw ? Real(double((*draw)[1].integer()) * 0x1p-53) : Real(0.5);
    }
    Real exponential() {
        const Json* draw = next();
        if (!draw) return Real(1e9);
        const bool given = draw->items.size() > 2 && (exponentials_given || (*draw)[1].is_null());
        if (given) return Real((*draw)[2].number());
        return -std::log(Real(1) - Real(double((*draw)[1].integer()) * 0x1p-53));
    }
};

// Variates of a generator of its own, 24 bits each, for statistics: in single precision none is 1.
struct Generator {
    std::mt19937_64 bits;

    Real uniform() { return Real(double(bits() >> 40) * 0x1p-24); }
    Real exponential() { return -std::log(Real(1) - uniform()); }
};

// Extinction linear between nodes, or what the trace of the case has where the field is scripted.
struct Field {
    static constexpr std::size_t most_kept = 1000;  // distances: those of a case

    std::vector<Real> s, sigma_t;
    const Json& trace;
    bool scripted;
    std::vector<Real>& lookups;
    std::size_t& count;

    Real operator()(Real at) const {
        if (++count <= most_kept) lookups.push_back(at);
        if (scripted) return lookups.size() <= trace.items.size() ? Real(trace[lookups.size() - 1][1].number()) : Real(0);
        std::size_t piece = 0;
        while (piece + 2 < s.size() && s[piece + 1] <= at) ++piece;
        const Real t = (at - s[piece]) / (s[piece + 1] - s[piece]);
        const Real clamped = std::min(std::max(t, Real(0)), Real(1));
        return (Real(1) - clamped) * sigma_t[piece] + clamped * sigma_t[piece + 1];
    }
};

// One estimate by the parameters of a case.
struct Estimate {
    std::vector<Real> values;
    const char* event = nullptr;
};

template <class Source>
static Estimate estimate(const Json& json, const Field& field, Source& source) {
    Estimate made;
    std::vector<Real>& values = made.values;
    const Real length = field.s.empty() ? Real(0) : field.s.back(), majorant = Real(json["knowledge"]["majorant"].number());
    if (const Json& estimator = json["estimator"]; !estimator.is_null()) {
        const std::string& kind = estimator["kind"].text;
        if (kind == "double_particle") {
            const Real control = estimator["control"].is_null() ? Real(0) : Real(estimator["control"]["sigma_t"].number());
            values = {fairflight::ratio_tracking(field, length, Real(estimator["sigma_samp"].number()), control, source)};
        } else if (kind == "woodcock") {
            values = {fairflight::woodcock(field, length, majorant, source)};
        } else if (kind == "jittered_ratio") {
            values = {fairflight::jittered_ratio(field, length, majorant, Real(estimator["epsilon"].number()), source)};
        } else if (kind == "unbiased_ray_marching") {
            const bool match_ends = estimator["endpoint_matching"].text == "true";
            values = {fairflight::unbiased_ray_marching(field, length, unsigned(estimator["teeth"].integer()), match_ends,
                                                        Real(estimator["roulette"].number()), source)};
        }
    } else if (const Json& sampler = json["sampler"]; sampler["kind"].text == "spectral_tracking") {
        const std::vector<Real> c = json["coefficients"].numbers();
        const auto flight =
            fairflight::spectral_tracking(field, length, {c[0], c[1], c[2]}, Real(sampler["sigma_samp"].number()), source);
        values = {flight.weights.begin(), flight.weights.end()};
        made.event = flight.collided ? "collided" : "escaped";
    } else if (sampler["kind"].text == "equiangular") {
        const std::vector<Real> origin = sampler["origin"].numbers(), direction = sampler["direction"].numbers(),
                                light = sampler["light"].numbers();
        Real closest = 0, squared = 0;
        for (int i = 0; i < 3; ++i) closest += (light[i] - origin[i]) * direction[i];
        for (int i = 0; i < 3; ++i) {
            const Real aside = light[i] - origin[i] - closest * direction[i];
            squared += aside * aside;
        }
        const auto [s, pdf] =
            fairflight::equiangular(closest, std::sqrt(squared), Real(sampler["length"].number()), source.uniform());
        values = {s, pdf};
    } else if (json["phase"]["kind"].text == "henyey_greenstein") {
        const Real g = Real(json["phase"]["g"].number()), cosine = fairflight::henyey_greenstein_cosine(g, source.uniform());
        values = {cosine, fairflight::henyey_greenstein(g, cosine)};
    }
    return made;
}

static Field field_of(const Json& json, std::vector<Real>& lookups, std::size_t& count) {
    const bool scripted = json["layer"].text == "field";
    return {json["profile"]["s"].numbers(), json["profile"]["sigma_t"].numbers(), json["trace"], scripted, lookups, count};
}

// Mean, variance and look-ups of as many estimates as are asked for.
static void print_statistics(const Json& json) {
    const std::size_t samples = std::size_t(json["samples"].integer());
    Generator source{std::mt19937_64(json["seed"].integer())};
    std::vector<Real> lookups;
    std::size_t count = 0;
    const Field field = field_of(json, lookups, count);
    // Welford's sums.
    double mean = 0, squares = 0;
    for (std::size_t i = 1; i <= samples; ++i) {
        const Estimate made = estimate(json, field, source);
        // A flight that collided scores nothing.
        const double score = made.event && std::string(made.event) == "collided" ? 0 : double(made.values.at(0));
        const double apart = score - mean;
        mean += apart / double(i);
        squares += apart * (score - mean);
    }
    std::printf("{\"id\":\"%s\",\"mean\":%.17g,\"variance\":%.17g,\"lookups\":%.17g}\n", json["id"].text.c_str(), mean,
                squares / double(samples - 1), double(count) / double(samples));
}

static void print(const Json& json) {
    if (json["layer"].text == "statistics") return print_statistics(json);
    Source source{json["draws"], json["layer"].text != "uniforms"};
    std::vector<Real> lookups;
    std::size_t count = 0;
    const Field field = field_of(json, lookups, count);
    const Estimate made = estimate(json, field, source);
    std::printf("{\"id\":\"%s\",\"draws\":%zu,\"lookups\":%zu", json["id"].text.c_str(), source.drawn, count);
    if (made.event) std::printf(",\"event\":\"%s\"", made.event);
    const auto numbers = [](const char* name, const std::vector<Real>& all) {
        std::printf(",\"%s\":[", name);
        for (std::size_t i = 0; i < all.size(); ++i) std::printf("%s%.17g", i ? "," : "", double(all[i]));
        std::printf("]");
    };
    numbers("value", made.values);
    numbers("s", lookups);
    std::printf("}\n");
}

int main() {
    for (std::string line; std::getline(std::cin, line);) print(Reader(line).value());
}
