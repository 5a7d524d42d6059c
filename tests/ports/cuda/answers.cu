// One case of the test vectors, replayed with the port in fairflight.cuh by one thread; answers.py brings it here.
#if !defined(__CUDA__) && !defined(__CUDACC__)
#include <cmath>
#endif
#include "fairflight.cuh"

// What answers.py packs.
struct Case {
    unsigned kind, layer, nodes, draws, trace, flag;
    float length, majorant, numbers[4];
};
struct Pair {
    float first, second;
};

// The variates of a case. What is drawn beyond them is told by the number of draws.
struct Source {
    const Pair* variates;
    unsigned count;
    bool exponentials_given;
    unsigned drawn;

    __device__ float uniform() { return drawn++ < count ? variates[drawn - 1].first : 0.5f; }
    __device__ float exponential() {
        if (drawn++ >= count) return 1e9f;
        const Pair& both = variates[drawn - 1];
        return exponentials_given ? both.second : -logf(1.0f - both.first);
    }
};

// Extinction linear between nodes, or that of the trace where it is given; writes down where it was asked.
struct Field {
    const Pair* nodes;
    unsigned count;
    const float* trace;
    unsigned given;
    bool is_scripted;
    float* distances;
    unsigned room, lookups;

    __device__ float operator()(float s) {
        if (lookups < room) distances[lookups] = s;
        ++lookups;
        if (is_scripted) return lookups <= given ? trace[lookups - 1] : 0.0f;
        unsigned piece = 0;
        while (piece + 2 < count && nodes[piece + 1].first <= s) ++piece;
        const Pair from = nodes[piece], to = nodes[piece + 1];
        const float t = fminf(fmaxf((s - from.first) / (to.first - from.first), 0.0f), 1.0f);
        return (1.0f - t) * from.second + t * to.second;
    }
};

// Answers: draws, look-ups, event, three values, and the distances of as many look-ups as there is room for.
extern "C" __global__ void answer(const Case* asked, const Pair* nodes, const Pair* variates, const float* trace, float* answers, unsigned room) {
    using namespace fairflight;
    const Case& it = *asked;
    const float(&n)[4] = it.numbers;
    Source source = {variates, it.draws, it.layer < 2, 0};
    Field field = {nodes, it.nodes, trace, it.trace, it.layer == 0, answers + 6, room, 0};
    float event = -1.0f, values[3] = {0.0f, 0.0f, 0.0f};
    switch (it.kind) {
        case 0: values[0] = ratio_tracking(field, it.length, n[0], n[1], source); break;
        case 1: values[0] = woodcock(field, it.length, it.majorant, source); break;
        case 2: values[0] = jittered_ratio(field, it.length, it.majorant, n[0], source); break;
        case 3: values[0] = unbiased_ray_marching(field, it.length, unsigned(n[1]), it.flag != 0, n[0], source); break;
        case 4: {
            const float coefficients[3] = {n[1], n[2], n[3]};
            const SpectralFlight flight = spectral_tracking(field, it.length, coefficients, n[0], source);
            for (int l = 0; l < 3; ++l) values[l] = flight.weights[l];
            event = flight.collided ? 1.0f : 0.0f;
            break;
        }
        case 5: values[0] = equiangular(n[0], n[1], it.length, source.uniform(), values[1]); break;
        default:
            values[0] = henyey_greenstein_cosine(n[0], source.uniform());
            values[1] = henyey_greenstein(n[0], values[0]);
    }
    answers[0] = float(source.drawn);
    answers[1] = float(field.lookups);
    answers[2] = event;
    for (int i = 0; i < 3; ++i) answers[3 + i] = values[i];
}
