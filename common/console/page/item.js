// A surface of the case, as it is drawn: where its vertices are and were at rest, its colour, how solid it is. What a
// message says of it goes to the graphics card as it came: positions as fractions of a box.

import * as THREE from "/three/build/three.module.js";

import {boxHalf, boxMiddle, boxOf, isEqual, placeOf, quantised, SCALE} from "./protocol.js";
import {surfaceFragment, surfaceVertex} from "./shaders.js";

const PRESSED = {
    skin: true,
    mesh: true
};  // where contact is shown

export class Item {
    // mesh: of a geometry; shared: {scale, toProbe}, the uniforms that all surfaces have in common.
    constructor(mesh, shared, opacity) {
        Object.assign(this, mesh);
        this.box = boxOf(mesh.positions);
        this.visible = true;
        this.version = 0;   // how many messages of positions there were
        this.range = null;  // of the values, where they came
        this.geometry = makeGeometry(mesh, this.box);
        this.material = makeMaterial(mesh, this.box, shared);
        this.solid = new THREE.Mesh(this.geometry, this.material);
        this.first = new THREE.Mesh(this.geometry, depthMaterial(this.material));
        this.solid.frustumCulled = this.first.frustumCulled = false;
        this.setOpacity(opacity);
    }

    dispose() {
        this.geometry.dispose();
        this.material.dispose();
        this.first.material.dispose();
    }

    get uniforms() {
        return this.material.uniforms;
    }

    setVisible(visible) {
        this.visible = visible;
        this.solid.visible = visible;
        this.first.visible = visible && this.opacity < 1;
    }

    // Larger surfaces are blended later: they are outside of the others.
    setOpacity(opacity) {
        this.opacity = opacity;
        this.uniforms.opacity.value = opacity;
        this.material.transparent = opacity < 1;
        this.first.renderOrder = 100 * this.size();
        this.solid.renderOrder = opacity < 1 ? 100 * this.size() + 1e-6 : 0;
        this.setVisible(this.visible);
    }

    // Half its diagonal, m.
    size() {
        return Math.hypot(...boxHalf(this.box));
    }

    // kind: of the probe's shape, 0 where nothing touches it; size: as shapeUniforms() has it.
    setContact(kind, size) {
        this.uniforms.probe_kind.value = PRESSED[this.kind] ? kind : 0;
        this.uniforms.probe_size.value.fromArray(size);
    }

    // colouring: "own", "displacement" or "values"; bones and what stands still keep their own.
    setColouring(colouring, low, high) {
        const moves = this.moves !== false && this.kind !== "bone";
        const number = {own: 0, displacement: 1, values: this.range ? 2 : 0}[colouring];
        this.uniforms.colouring.value = moves ? number : 0;
        this.uniforms.range.value.set(low, high);
    }

    // ---- positions

    // Takes a part of a message of positions. Whether anything differs from what is drawn.
    take(part) {
        this.version++;
        if (this.isSame(part)) return false;
        const {position, value} = this.geometry.attributes;
        this.box = part.box;
        position.array.set(part.positions);
        position.needsUpdate = true;
        this.uniforms.middle.value.fromArray(boxMiddle(part.box));
        this.uniforms.half_size.value.fromArray(boxHalf(part.box));
        this.range = part.values ? [part.low, part.high] : null;
        if (part.values) {
            value.array.set(part.values);
            value.needsUpdate = true;
        }
        return true;
    }

    isSame(part) {
        const {position, value} = this.geometry.attributes;
        if (part.box.some((x, i) => x !== this.box[i])) return false;
        if (Boolean(part.values) !== Boolean(this.range)) return false;
        if (part.values && (part.low !== this.range[0] || part.high !== this.range[1])) return false;
        return isEqual(position.array, part.positions) && (!part.values || isEqual(value.array, part.values));
    }

    // Where a vertex is now, and where it was at rest, m.
    placeNow(vertex) {
        return new THREE.Vector3().fromArray(placeOf(this.geometry.attributes.position.array, this.box, vertex));
    }

    placeAtRest(vertex) {
        return new THREE.Vector3().fromArray(this.positions, 3 * vertex);
    }

    positionsNow() {
        const {array} = this.geometry.attributes.position;
        const now = new Float32Array(3 * this.count);
        for (let i = 0; i < this.count; i++) now.set(placeOf(array, this.box, i), 3 * i);
        return now;
    }

    // The largest displacement of a vertex, m.
    largestMoved() {
        let most = 0;
        const middle = boxMiddle(this.box);
        const half = boxHalf(this.box).map((x) => x / SCALE);
        const now = this.geometry.attributes.position.array;
        for (let i = 0; i < now.length; i += 3) {
            let square = 0;
            for (let j = 0; j < 3; j++) square += (middle[j] + half[j] * now[i + j] - this.positions[i + j]) ** 2;
            most = Math.max(most, square);
        }
        return Math.sqrt(most);
    }
}

function makeGeometry(mesh, box) {
    const geometry = new THREE.BufferGeometry();
    const now = new THREE.BufferAttribute(quantised(mesh.positions, box), 3, true);
    const value = new THREE.BufferAttribute(new Uint8Array(mesh.count), 1, true);
    now.setUsage(THREE.DynamicDrawUsage);
    value.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute("position", now);
    geometry.setAttribute("rest", new THREE.BufferAttribute(mesh.positions, 3));
    geometry.setAttribute("value", value);
    geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    return geometry;
}

function makeMaterial(mesh, box, {scale, toProbe}) {
    return new THREE.ShaderMaterial({
        vertexShader: surfaceVertex,
        fragmentShader: surfaceFragment,
        side: THREE.DoubleSide,
        uniforms: {
            middle: {value: new THREE.Vector3().fromArray(boxMiddle(box))},
            half_size: {value: new THREE.Vector3().fromArray(boxHalf(box))},
            colour: {value: new THREE.Color(mesh.colour || "#b9a08c")},
            opacity: {value: 1},
            colouring: {value: 0},
            range: {value: new THREE.Vector2(0, 1)},
            scale: {value: scale},
            probe_kind: {value: 0},
            probe_size: {value: new THREE.Vector4()},
            to_probe: {value: toProbe},
        },
    });
}

// Lays down the depth of a surface that is seen through, so that only its nearest layer is blended.
function depthMaterial(material) {
    const depth = material.clone();
    depth.uniforms = material.uniforms;
    depth.colorWrite = false;
    depth.transparent = true;
    return depth;
}
