// Shaders of the surfaces and of the image. Normals come from derivatives of the place in the fragment shader, so that
// nothing but positions is sent; positions are fractions of a box (normalised 16-bit integers).

export const surfaceVertex = `
    attribute vec3 rest;
    attribute float value;
    uniform vec3 middle, half_size;
    varying vec3 place, seen;
    varying float moved, given;
    void main() {
        place = middle + half_size * position;
        moved = length(place - rest);
        given = value;
        vec4 eye = viewMatrix * vec4(place, 1.0);
        seen = eye.xyz;
        gl_Position = projectionMatrix * eye;
    }`;

// The signed distance to the probe is common/probe's, of a sphere, a rounded box and a rounded sector; the tint only
// shows where the skin lies against it.
export const surfaceFragment = `
    uniform vec3 colour;
    uniform float opacity;
    uniform int colouring; // 0: the surface's own; 1: by displacement; 2: by values
    uniform vec2 range;
    uniform sampler2D scale;
    uniform int probe_kind;
    uniform vec4 probe_size;
    uniform mat4 to_probe;
    varying vec3 place, seen;
    varying float moved, given;

    float round_box(vec3 p, vec3 size, float edge) {
        vec3 q = abs(p) - size + edge;
        return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0) - edge;
    }

    float sector(vec2 p, float radius, float angle) {
        p.x = abs(p.x);
        float far = length(p) - radius;
        vec2 side = vec2(sin(angle), cos(angle));
        float beside = length(p - side * clamp(dot(p, side), 0.0, radius));
        return max(far, beside * sign(side.y * p.x - side.x * p.y));
    }

    float distance_to_probe(vec3 p) {
        if (probe_kind == 1) return length(p + vec3(0.0, 0.0, probe_size.x)) - probe_size.x;
        if (probe_kind == 2) {
            float tall = max(probe_size.x, probe_size.y);
            vec3 size = 0.5 * vec3(probe_size.x, probe_size.y, tall);
            return round_box(p + vec3(0.0, 0.0, 0.5 * tall), size, probe_size.z);
        }
        if (probe_kind == 3) {
            float flat_way = sector(vec2(p.x, p.z + probe_size.x), probe_size.x, probe_size.w) + probe_size.z;
            vec2 q = vec2(flat_way, abs(p.y) - 0.5 * probe_size.y + probe_size.z);
            return min(max(q.x, q.y), 0.0) + length(max(q, 0.0)) - probe_size.z;
        }
        return 1.0;
    }

    void main() {
        vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
        vec3 toward = normalize(-seen);
        if (dot(normal, toward) < 0.0) normal = -normal;
        vec3 base = colour;
        float at = colouring == 1 ? (moved - range.x) / max(range.y - range.x, 1e-9) : given;
        if (colouring > 0) base = texture2D(scale, vec2(clamp(at, 0.002, 0.998), 0.5)).rgb;
        float touch = 1.0 - smoothstep(0.0004, 0.0012, distance_to_probe((to_probe * vec4(place, 1.0)).xyz));
        base = mix(base, vec3(0.95, 0.66, 0.23), 0.75 * touch);
        float key = max(dot(normal, normalize(vec3(0.35, 0.6, 0.7))), 0.0);
        float head = max(dot(normal, toward), 0.0);
        float shine = pow(max(dot(normal, normalize(toward + vec3(0.35, 0.6, 0.7))), 0.0), 24.0);
        gl_FragColor = vec4(base * (0.3 + 0.42 * key + 0.5 * head) + 0.06 * shine, opacity);
    }`;

export const imageVertex = `
    uniform vec3 corner, along, down;
    uniform vec2 size;
    varying vec2 at;
    void main() {
        at = uv * size;
        gl_Position = projectionMatrix * viewMatrix * vec4(corner + uv.x * along + uv.y * down, 1.0);
    }`;

// Of a fan, what lies outside of it is left out: fan is its tip in the image (m from its corner), the radius of its
// face and half its angle; no fan where the angle is 0.
export const imageFragment = `
    uniform sampler2D pixels;
    uniform vec2 size;
    uniform vec4 fan;
    uniform float opacity;
    varying vec2 at;
    void main() {
        vec2 from = at - fan.xy;
        if (fan.w > 0.0 && (abs(atan(from.x, from.y)) > fan.w || length(from) < fan.z)) discard;
        gl_FragColor = vec4(texture2D(pixels, at / size).rgb, opacity);
    }`;
