// One case of the test vectors, replayed with the port in fairflight.wgsl.

struct Case {
    kind: u32,
    // 0: the trace's extinction; 1: exponentials given; 2: all from uniform variates.
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
}

@group(0) @binding(0) var<storage, read> asked: Case;
// Nodes: position and extinction; variates: uniform and exponential (-1 where none is given); extinctions of the trace.
@group(0) @binding(1) var<storage, read> nodes: array<vec2<f32>>;
@group(0) @binding(2) var<storage, read> variates: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read> trace: array<f32>;
// Draws, look-ups, event, values, and the distances of look-ups.
@group(0) @binding(4) var<storage, read_write> answer: array<f32>;

const DISTANCES = 6u;

var<private> drawn = 0u;
var<private> lookups = 0u;

fn draw() -> vec2<f32> {
    drawn++;
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
    if asked.layer < 2u || drawn > asked.draws {
        return both.y;
    }
    return -log(1.0 - both.x);
}

fn field(s: f32) -> f32 {
    if lookups + DISTANCES < arrayLength(&answer) {
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

@compute @workgroup_size(1)
fn main() {
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
    answer[0] = f32(drawn);
    answer[1] = f32(lookups);
    answer[2] = event;
    answer[3] = values.x;
    answer[4] = values.y;
    answer[5] = values.z;
}
