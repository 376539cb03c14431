// Draws the scene by the processor, for browsers without a graphics card: they would draw WebGL by the processor too,
// at some .6 us a triangle on two processors, however plain its shader, and this takes a tenth of that on one. What is
// drawn, and how it is lit, is what shaders.js and three.js draw; lengths are in metres, in the eye's frame (-z ahead).
//
// Depths are 1 / distance, which is linear on the screen. Pixels are words: alpha, blue, green, red.

import {Vector3} from "/three/build/three.module.js";

import {scaleBytes} from "./colours.js";
import {boxHalf, boxMiddle, SCALE} from "./protocol.js";
import {distanceToProbe} from "./shapes.js";

const CLEAR = 0xff1b1815;  // view.js's colour of nothing
const KEY = [0.35, 0.6, 0.7].map((x) => x / Math.hypot(0.35, 0.6, 0.7));
const TINT = [242, 168, 59];    // of contact
const NEAR = [0.0004, 0.0012];  // m: within the first it is full, beyond the second it is none
const CORNER = 6;               // numbers of a corner: x, y on the screen, depth, and its place

const word = (red, green, blue) =>
    0xff000000 | (Math.min(blue, 255) << 16) | (Math.min(green, 255) << 8) | Math.min(red, 255);

const numbers = (count) => new Float32Array(count);

export class Raster {
    constructor(canvas) {
        this.canvas = canvas;
        this.to = canvas.getContext("2d", {alpha: false});
        this.corners = numbers(0);
        this.scale = scaleBytes();
        this.light = {flat: 0, shine: 0};
        this.sampled = {canvas: document.createElement("canvas")};
        this.setSize(1, 1);
    }

    setSize(width, height) {
        [this.canvas.width, this.canvas.height] = [this.width, this.height] = [width, height];
        this.picture = new ImageData(width, height);
        const words = new Uint32Array(this.picture.data.buffer);
        this.solid = {colour: words, depth: numbers(words.length), over: null};
        this.layer = {colour: new Uint32Array(words.length), depth: numbers(words.length), over: this.solid.depth};
    }

    // What hides is drawn first, then what is seen through: the smaller first, which is inside of the larger.
    render({scene, camera, items, image, up}) {
        scene.updateMatrixWorld();
        this.look(camera, up);
        this.solid.colour.fill(CLEAR);
        this.solid.depth.fill(0);
        const shown = [...items.values()].filter((item) => item.visible && item.opacity > 0);
        for (const item of shown)
            if (item.opacity >= 1) this.surface(item, this.solid);
        for (const object of scene.children)
            if (object.type === "Group" && object.visible) this.group(object);
        if (image.mesh.visible) this.blended(image.material.uniforms.opacity.value, (to) => this.image(image, to));
        const through = shown.filter((item) => item.opacity < 1).sort((a, b) => a.size() - b.size());
        for (const item of through) this.blended(item.opacity, (to) => this.surface(item, to));
        this.to.putImageData(this.picture, 0, 0);
    }

    look(camera, up) {
        const across = camera.projectionMatrix.elements;
        [this.fx, this.fy] = [(across[0] * this.width) / 2, (across[5] * this.height) / 2];
        this.near = camera.near;
        this.toEye = camera.matrixWorldInverse;
        this.fromEye = camera.matrixWorld;
        this.up = new Vector3().fromArray(up).transformDirection(this.toEye);
    }

    // Of what is seen through, the nearest layer is blended.
    blended(opacity, draw) {
        if (opacity >= 1) {
            draw(this.solid);
            return;
        }
        this.layer.depth.fill(0);
        draw(this.layer);
        const part = Math.round(256 * opacity);
        const {colour: above, depth: far} = this.layer;
        const {colour, depth} = this.solid;
        for (let p = 0; p < far.length; p++) {
            if (far[p] === 0) continue;
            colour[p] = mixed(colour[p], above[p], part);
            depth[p] = far[p];
        }
    }

    // ---- corners

    // Puts n corners on the screen: places from (x, y, z) by m, the columns of a matrix. A depth of 0: behind the eye.
    project(places, n, m) {
        if (this.corners.length < CORNER * n) this.corners = numbers(CORNER * n);
        const {corners, fx, fy, near} = this;
        const [middleX, middleY] = [this.width / 2, this.height / 2];
        const [m0, m1, m2, , m4, m5, m6, , m8, m9, m10, , m12, m13, m14] = m;
        for (let i = 0, at = 0; i < 3 * n; i += 3, at += CORNER) {
            const [x, y, z] = [places[i], places[i + 1], places[i + 2]];
            const [eyeX, eyeY] = [m0 * x + m4 * y + m8 * z + m12, m1 * x + m5 * y + m9 * z + m13];
            const eyeZ = m2 * x + m6 * y + m10 * z + m14;
            const depth = -eyeZ > near ? -1 / eyeZ : 0;
            corners[at] = middleX + fx * eyeX * depth;
            corners[at + 1] = middleY - fy * eyeY * depth;
            corners[at + 2] = depth;
            corners[at + 3] = eyeX;
            corners[at + 4] = eyeY;
            corners[at + 5] = eyeZ;
        }
    }

    // ---- triangles

    // begin(a, b, c) is asked for the colour of a triangle when its first pixel is drawn; null: each(a, b, c, u, v, x,
    // y, depth) has the colour of each pixel, 0 for none. u and v are the shares of the corners a and b.
    fill(to, count, index, begin, each) {
        const {corners: k, width, height} = this;
        const {colour, depth, over} = to;
        for (let t = 0; t < count; t += 3) {
            const a = CORNER * (index ? index[t] : t);
            const b = CORNER * (index ? index[t + 1] : t + 1);
            const c = CORNER * (index ? index[t + 2] : t + 2);
            const ax = k[a], bx = k[b], cx = k[c], ay = k[a + 1], by = k[b + 1], cy = k[c + 1];
            // Columns and rows whose middles are within.
            const left = Math.max(Math.ceil(Math.min(ax, bx, cx) - 0.5), 0);
            const right = Math.min(Math.floor(Math.max(ax, bx, cx) - 0.5), width - 1);
            if (left > right) continue;
            const top = Math.max(Math.ceil(Math.min(ay, by, cy) - 0.5), 0);
            const bottom = Math.min(Math.floor(Math.max(ay, by, cy) - 0.5), height - 1);
            if (top > bottom) continue;
            const az = k[a + 2], bz = k[b + 2], cz = k[c + 2];
            const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
            if (area === 0 || az === 0 || bz === 0 || cz === 0) continue;
            const ux = (by - cy) / area, uy = (cx - bx) / area, vx = (cy - ay) / area, vy = (ax - cx) / area;
            const zx = ux * (az - cz) + vx * (bz - cz), zy = uy * (az - cz) + vy * (bz - cz);
            let rowU = ux * (left + 0.5 - cx) + uy * (top + 0.5 - cy);
            let rowV = vx * (left + 0.5 - cx) + vy * (top + 0.5 - cy);
            let rowZ = cz + rowU * (az - cz) + rowV * (bz - cz);
            let flat = 0;
            let asked = false;
            for (let y = top; y <= bottom; y++, rowU += uy, rowV += vy, rowZ += zy) {
                let u = rowU, v = rowV, z = rowZ;
                for (let x = left, p = y * width + left; x <= right; x++, p++, u += ux, v += vx, z += zx) {
                    if (u < 0 || v < 0 || u + v > 1 || z <= depth[p] || (over !== null && z <= over[p])) continue;
                    if (!asked) flat = begin(a, b, c);
                    asked = true;
                    const is = flat !== null ? flat : each(a, b, c, u, v, x, y, z);
                    if (is === 0) continue;
                    colour[p] = is;
                    depth[p] = z;
                }
            }
        }
    }

    // The light of surfaceFragment on a triangle, in this.light: a colour's factor, and what is added to it.
    shine(a, b, c) {
        const k = this.corners;
        const x = k[b + 3] - k[a + 3], y = k[b + 4] - k[a + 4], z = k[b + 5] - k[a + 5];
        const s = k[c + 3] - k[a + 3], t = k[c + 4] - k[a + 4], w = k[c + 5] - k[a + 5];
        let nx = y * w - z * t, ny = z * s - x * w, nz = x * t - y * s;
        let tx = -(k[a + 3] + k[b + 3] + k[c + 3]), ty = -(k[a + 4] + k[b + 4] + k[c + 4]);
        let tz = -(k[a + 5] + k[b + 5] + k[c + 5]);
        const away = 1 / Math.sqrt(tx * tx + ty * ty + tz * tz);
        tx *= away;
        ty *= away;
        tz *= away;
        const long = Math.sqrt(nx * nx + ny * ny + nz * nz) || 1;
        const sign = (nx * tx + ny * ty + nz * tz < 0 ? -1 : 1) / long;
        nx *= sign;
        ny *= sign;
        nz *= sign;
        const key = Math.max(nx * KEY[0] + ny * KEY[1] + nz * KEY[2], 0);
        const hx = tx + 0.35, hy = ty + 0.6, hz = tz + 0.7;
        const half = Math.max((nx * hx + ny * hy + nz * hz) / Math.sqrt(hx * hx + hy * hy + hz * hz), 0);
        this.light.flat = 0.3 + 0.42 * key + 0.5 * Math.max(nx * tx + ny * ty + nz * tz, 0);
        this.light.shine = half > 0.8 ? 255 * 0.06 * half ** 24 : 0;
    }

    // ---- surfaces

    surface(item, to) {
        const {uniforms, count, triangles} = item;
        const middle = boxMiddle(item.box);
        const half = boxHalf(item.box).map((x) => x / SCALE);
        this.project(item.geometry.attributes.position.array, count, placed(this.toEye.elements, middle, half));
        const own = uniforms.colour.value.toArray().map((x) => 255 * x);
        const values = uniforms.colouring.value ? this.valuesOf(item) : null;
        const near = uniforms.probe_kind.value ? this.contactOf(uniforms) : null;
        const {light} = this;
        const begin = (a, b, c) => {
            this.shine(a, b, c);
            if (values || (near && near.meets(a, b, c))) return null;
            return word(light.flat * own[0] + light.shine, light.flat * own[1] + light.shine,
                light.flat * own[2] + light.shine);
        };
        const base = [0, 0, 0];
        const each = (a, b, c, u, v, x, y, depth) => {
            this.baseOf(base, own, values, a, b, c, u, v);
            if (near) near.tint(base, x, y, depth);
            return word(light.flat * base[0] + light.shine, light.flat * base[1] + light.shine,
                light.flat * base[2] + light.shine);
        };
        this.fill(to, triangles.length, triangles, begin, each);
    }

    // 0 to 255 of each vertex.
    valuesOf({uniforms, geometry, count, positions, box}) {
        if (uniforms.colouring.value === 2) return geometry.attributes.value.array;
        const [low, high] = uniforms.range.value.toArray();
        const now = geometry.attributes.position.array;
        const middle = boxMiddle(box);
        const half = boxHalf(box).map((x) => x / SCALE);
        const made = new Uint8ClampedArray(count);
        for (let i = 0; i < count; i++) {
            let square = 0;
            for (let j = 0; j < 3; j++) square += (middle[j] + half[j] * now[3 * i + j] - positions[3 * i + j]) ** 2;
            made[i] = (255 * (Math.sqrt(square) - low)) / Math.max(high - low, 1e-9);
        }
        return made;
    }

    baseOf(base, own, values, a, b, c, u, v) {
        if (!values) {
            [base[0], base[1], base[2]] = own;
            return;
        }
        const value = u * values[a / CORNER] + v * values[b / CORNER] + (1 - u - v) * values[c / CORNER];
        const at = 4 * Math.round(value);
        for (let i = 0; i < 3; i++) base[i] = this.scale[at + i];
    }

    // The tint where a surface lies against the probe.
    contactOf({probe_kind, probe_size, to_probe}) {
        const m = to_probe.value.clone().multiply(this.fromEye).elements;
        const size = probe_size.value.toArray();
        const distance = (x, y, z) => distanceToProbe(probe_kind.value, size, m[0] * x + m[4] * y + m[8] * z + m[12],
            m[1] * x + m[5] * y + m[9] * z + m[13], m[2] * x + m[6] * y + m[10] * z + m[14]);
        const k = this.corners;
        const apart = (a, b) => Math.hypot(k[a + 3] - k[b + 3], k[a + 4] - k[b + 4], k[a + 5] - k[b + 5]);
        return {
            meets: (a, b, c) => distance(k[a + 3], k[a + 4], k[a + 5]) < Math.max(apart(a, b), apart(a, c)) + NEAR[1],
            tint: (base, x, y, depth) => {
                const far = distance(...this.placeOf(x, y, depth));
                const t = Math.min(Math.max((far - NEAR[0]) / (NEAR[1] - NEAR[0]), 0), 1);
                const share = 0.75 * (1 - t * t * (3 - 2 * t));
                for (let i = 0; i < 3; i++) base[i] += share * (TINT[i] - base[i]);
            }
        };
    }

    // Of a pixel.
    placeOf(x, y, depth) {
        const away = 1 / depth;
        return [((x + 0.5 - this.width / 2) * away) / this.fx, ((this.height / 2 - y - 0.5) * away) / this.fy, -away];
    }

    // ---- the probe, and the rods of pulls

    group(group) {
        group.traverse((mesh) => {
            if (mesh.isMesh && mesh.visible) this.mesh(mesh);
        });
    }

    // Lit at its corners, about as three.js lights it.
    mesh({geometry, material, matrixWorld}) {
        const {position, normal} = geometry.attributes;
        const m = this.toEye.clone().multiply(matrixWorld);
        this.project(position.array, position.count, m.elements);
        const own = material.color.toArray().map((x) => 255 * x);
        const light = normal && material.isMeshPhongMaterial ? lightOn(normal, m.elements, this.up) : null;
        const plain = word(...own);
        const begin = () => (light ? null : plain);
        const each = (a, b, c, u, v) => {
            const is = u * light[a / CORNER] + v * light[b / CORNER] + (1 - u - v) * light[c / CORNER];
            return word(is * own[0], is * own[1], is * own[2]);
        };
        const index = geometry.index ? geometry.index.array : null;
        this.fill(this.solid, index ? index.length : position.count, index, begin, each);
    }

    // ---- the image

    image({material: {uniforms}}, to) {
        const [corner, along, down] = ["corner", "along", "down"].map((name) => uniforms[name].value);
        const texture = uniforms.pixels.value;
        const places = [0, 1, 2, 3].flatMap(
            (i) => corner.clone().addScaledVector(along, i & 1).addScaledVector(down, i >> 1).toArray());
        this.project(places, 4, this.toEye.elements);
        const {pixels, columns, rows} = this.sample(texture);
        const [wide, high] = uniforms.size.value.toArray();
        const [tipX, tipY, radius, angle] = uniforms.fan.value.toArray();
        const eye = corner.clone().applyMatrix4(this.toEye);
        const [x, y] = [along, down].map((way) => way.clone().transformDirection(this.toEye));
        const each = (a, b, c, u, v, atX, atY, depth) => {
            const place = this.placeOf(atX, atY, depth);
            const right = x.x * (place[0] - eye.x) + x.y * (place[1] - eye.y) + x.z * (place[2] - eye.z);
            const below = y.x * (place[0] - eye.x) + y.y * (place[1] - eye.y) + y.z * (place[2] - eye.z);
            const [fromX, fromY] = [right - tipX, below - tipY];
            if (angle > 0 && (Math.abs(Math.atan2(fromX, fromY)) > angle || Math.hypot(fromX, fromY) < radius))
                return 0;
            const column = Math.min(Math.max(Math.floor((right / wide) * columns), 0), columns - 1);
            const row = Math.min(Math.max(Math.floor((below / high) * rows), 0), rows - 1);
            return pixels[row * columns + column];
        };
        this.fill(to, 6, [0, 1, 2, 2, 1, 3], () => null, each);
    }

    // The pixels of a texture, about as many as it covers on the screen, so that none is left out.
    sample(texture) {
        const {image, version} = texture;
        const k = this.corners;
        const long = (a, b) => Math.hypot(k[CORNER * a] - k[CORNER * b], k[CORNER * a + 1] - k[CORNER * b + 1]);
        const fits = (most, pixels) => Math.max(Math.min(Math.ceil(pixels), most), 1);
        const columns = fits(image.width, Math.max(long(0, 1), long(2, 3)));
        const rows = fits(image.height, Math.max(long(0, 2), long(1, 3)));
        const {canvas} = this.sampled;
        const isSame = this.sampled.of === texture && this.sampled.version === version;
        if (isSame && canvas.width === columns && canvas.height === rows) return this.sampled;
        if (canvas.width !== columns || canvas.height !== rows) [canvas.width, canvas.height] = [columns, rows];
        const to = canvas.getContext("2d", {alpha: false, willReadFrequently: true});
        to.imageSmoothingQuality = "medium";
        to.drawImage(image, 0, 0, columns, rows);
        const pixels = new Uint32Array(to.getImageData(0, 0, columns, rows).data.buffer);
        this.sampled = {canvas, of: texture, version, pixels, columns, rows};
        return this.sampled;
    }
}

// part: of 256.
function mixed(below, above, part) {
    const even = 0xff00ff;
    const odd = (((below >>> 8) & even) * (256 - part) + ((above >>> 8) & even) * part) & 0xff00ff00;
    return odd | ((((below & even) * (256 - part) + (above & even) * part) >>> 8) & even) | 0xff000000;
}

// m after a box's fractions have become places.
function placed(m, middle, half) {
    const made = Array.from(m);
    for (let i = 0; i < 3; i++) {
        made[12 + i] += m[i] * middle[0] + m[4 + i] * middle[1] + m[8 + i] * middle[2];
        for (let j = 0; j < 3; j++) made[4 * j + i] *= half[j];
    }
    return made;
}

// Of each corner, from view.js's sky and its light at the camera. m: to the eye; up: as the eye sees it.
function lightOn(normal, m, up) {
    const {array, count} = normal;
    const made = numbers(count);
    for (let i = 0; i < count; i++) {
        const [x, y, z] = [array[3 * i], array[3 * i + 1], array[3 * i + 2]];
        const n = [0, 1, 2].map((j) => m[j] * x + m[4 + j] * y + m[8 + j] * z);
        const long = Math.hypot(...n) || 1;
        const sky = 0.5 + (0.5 * (n[0] * up.x + n[1] * up.y + n[2] * up.z)) / long;
        const key = Math.max(0.188 * n[0] + 0.281 * n[1] + 0.941 * n[2], 0) / long;
        made[i] = 0.7 * (0.455 + 0.475 * sky) + 0.6 * key;
    }
    return made;
}
