// One case of the test vectors, replayed with the port in fairflight.wgsl; or many estimates of its parameters, from a generator.

struct Case {
    kind: u32,
    // 0: the trace's extinction; 1: exponentials given; 2: all from uniform variates; 3: statistics, from a generator.
    layer: u32,
    nodes: u32,
    draws: u32,
    trace: u32,
    flag: u32,
    length: f32,
    majorant: f32,
    // What the kind takes.
    a: f32,
    b: f32,
    c: f32,
    d: f32,
    // Statistics: a seed, invocations, and estimates of each.
    seed: u32,
    invocations: u32,
    estimates: u32,
}

@group(0) @binding(0) var<storage, read> asked: Case;
// Nodes: position and extinction; variates: uniform and exponential (-1 where none is given); extinctions of the trace.
@group(0) @binding(1) var<storage, read> nodes: array<vec2<f32>>;
@group(0) @binding(2) var<storage, read> variates: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read> trace: array<f32>;
// Draws, look-ups, event, values, and the distances of look-ups; or of each invocation the sum of its estimates, that of their squares, and look-ups.
@group(0) @binding(4) var<storage, read_write> answer: array<f32>;

const DISTANCES = 6u;

const STATISTICS = 3u;

var<private> drawn = 0u;
var<private> lookups = 0u;
var<private> state: vec4<u32>;

// Mixes the bits of a word.
fn mixed(word: u32) -> u32 {
    var x = word;
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}

// A stream of its own for each invocation.
fn begin(invocation: u32) {
    for (var i = 0u; i < 4u; i++) {
        state[i] = mixed(mixed(mixed(asked.seed) + invocation) + i + 1u);
    }
}

fn rotated(x: u32, by: u32) -> u32 {
    return (x << by) | (x >> (32u - by));
}

// xoshiro128++: blackman-2021.
fn next_bits() -> u32 {
    let result = rotated(state.x + state.w, 7u) + state.x;
    let shifted = state.y << 9u;
    state.z ^= state.x;
    state.w ^= state.y;
    state.y ^= state.z;
    state.x ^= state.w;
    state.z ^= shifted;
    state.w = rotated(state.w, 11u);
    return result;
}

fn draw() -> vec2<f32> {
    drawn++;
    if asked.layer == STATISTICS {
        return vec2<f32>(f32(next_bits() >> 8u) * 5.9604645e-8, -1.0);
    }
    if drawn > asked.draws {
        return vec2<f32>(0.5, 1e9);
    }
    return variates[drawn - 1u];
}

fn uniform_variate() -> f32 {
    return draw().x;
}

fn exponential_variate() -> f32 {
    let both = draw();
    if asked.layer < 2u || asked.layer == 2u && drawn > asked.draws {
        return both.y;
    }
    return -log(1.0 - both.x);
}

fn field(s: f32) -> f32 {
    if asked.layer != STATISTICS && lookups + DISTANCES < arrayLength(&answer) {
        answer[DISTANCES + lookups] = s;
    }
    lookups++;
    if asked.layer == 0u {
        if lookups > asked.trace {
            return 0.0;
        }
        return trace[lookups - 1u];
    }
    var piece = 0u;
    while piece + 2u < asked.nodes && nodes[piece + 1u].x <= s {
        piece++;
    }
    let from_node = nodes[piece];
    let to_node = nodes[piece + 1u];
    let t = clamp((s - from_node.x) / (to_node.x - from_node.x), 0.0, 1.0);
    return (1.0 - t) * from_node.y + t * to_node.y;
}

// Values of an estimate, and 1 for a flight that collided, 0 for one that escaped, -1 for what is no flight.
struct Estimate {
    values: vec3<f32>,
    event: f32,
}

fn estimate() -> Estimate {
    let length = asked.length;
    var values = vec3<f32>(0.0);
    var event = -1.0;
    switch asked.kind {
        case 0u: { values.x = ratio_tracking(length, asked.a, asked.b); }
        case 1u: { values.x = woodcock(length, asked.majorant); }
        case 2u: { values.x = jittered_ratio(length, asked.majorant, asked.a); }
        case 3u: { values.x = unbiased_ray_marching(length, u32(asked.b), asked.flag == 1u, asked.a); }
        case 4u: {
            let flight = spectral_tracking(length, vec3<f32>(asked.b, asked.c, asked.d), asked.a);
            values = flight.weights;
            event = f32(flight.collided);
        }
        case 5u: {
            let sample = equiangular(asked.a, asked.b, length, uniform_variate());
            values = vec3<f32>(sample, 0.0);
        }
        default: {
            let cosine = henyey_greenstein_cosine(asked.a, uniform_variate());
            values = vec3<f32>(cosine, henyey_greenstein(asked.a, cosine), 0.0);
        }
    }
    return Estimate(values, event);
}

@compute @workgroup_size(1)
fn main() {
    let found = estimate();
    answer[0] = f32(drawn);
    answer[1] = f32(lookups);
    answer[2] = found.event;
    answer[3] = found.values.x;
    answer[4] = found.values.y;
    answer[5] = found.values.z;
}

@compute @workgroup_size(64)
fn statistics(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= asked.invocations {
        return;
    }
    begin(id.x);
    var sum = 0.0;
    var squares = 0.0;
    for (var i = 0u; i < asked.estimates; i++) {
        let found = estimate();
        // A flight that collided scores nothing.
        let score = select(found.values.x, 0.0, found.event == 1.0);
        sum += score;
        squares += score * score;
    }
    answer[3u * id.x] = sum;
    answer[3u * id.x + 1u] = squares;
    answer[3u * id.x + 2u] = f32(lookups);
}
