// Probes as they are drawn: their shapes, from the words of --probe, in the probe's frame (the origin in the middle of
// the face, +z into the tissue, +x along the image's columns). A handle and a mark on the +x side are added to each.

import * as THREE from "/three/build/three.module.js";

const METRES = { um: 1e-6, mm: 1e-3, cm: 1e-2, m: 1, in: 0.0254 };

// A length in the words of a command line, m; NaN where it is none.
export function metres(text) {
    const match = /^\s*([-+0-9.e]+)\s*(um|mm|cm|m|in)?\s*$/i.exec(text);
    return match ? Number(match[1]) * METRES[match[2] || "m"] : NaN;
}

// {kind: "sphere", radius}, {kind: "linear", width, thickness, edge}, {kind: "curved", radius, angle (radians),
// thickness, edge}, all in m; null for what has no such words, as a convex polyhedron.
export function parseShape(text) {
    const [kind, rest = ""] = (text || "").split(":");
    const words = rest.split(",");
    if (kind === "sphere") return {kind, radius: metres(words[0])};
    if (kind === "linear") {
        const [width, thickness] = words.map(metres);
        return {kind, width, thickness, edge: words[2] ? metres(words[2]) : Math.min(width, thickness) / 4};
    }
    if (kind === "curved") {
        const thickness = metres(words[2] || "");
        const angle = (Number(words[1]) * Math.PI) / 180;
        return {kind, radius: metres(words[0]), angle, thickness, edge: words[3] ? metres(words[3]) : thickness / 4};
    }
    return null;
}

// m: how far the face reaches to the sides, over which the skin's normal is a mean.
export function reachOf(shape) {
    if (!shape) return 0.01;
    if (shape.kind === "sphere") return shape.radius / 2;
    if (shape.kind === "linear") return shape.width / 2;
    return shape.radius * Math.sin(Math.min(shape.angle, Math.PI) / 2);
}

function roundedBox(half, edge) {
    const geometry = new THREE.BoxBufferGeometry(2 * half.x, 2 * half.y, 2 * half.z, 12, 12, 12);
    const position = geometry.attributes.position;
    const v = new THREE.Vector3();
    const inner = half.clone().subScalar(edge);
    for (let i = 0; i < position.count; i++) {
        v.fromBufferAttribute(position, i);
        const core = v.clone().clamp(inner.clone().negate(), inner);
        if (v.distanceTo(core) > 0) v.sub(core).normalize().multiplyScalar(edge).add(core);
        position.setXYZ(i, v.x, v.y, v.z);
    }
    geometry.computeVertexNormals();
    return geometry;
}

function linearHead(shape) {
    const tall = Math.max(shape.width, shape.thickness);
    const half = new THREE.Vector3(shape.width, shape.thickness, tall).multiplyScalar(0.5);
    return {geometry: roundedBox(half, shape.edge).translate(0, 0, -tall / 2), tall, width: shape.width};
}

function curvedHead(shape) {
    const outline = new THREE.Shape();
    const edge = Math.min(shape.edge, shape.radius / 4);
    const radius = shape.radius - edge;
    const half = shape.angle / 2;
    outline.moveTo(0, 0);
    for (let i = 0; i <= 24; i++) {
        const a = -half + (i / 24) * shape.angle;
        outline.lineTo(radius * Math.sin(a), radius * Math.cos(a));
    }
    const depth = Math.max(shape.thickness - 2 * edge, 1e-4);
    const bevel = {bevelEnabled: true, bevelSize: edge, bevelThickness: edge, bevelSegments: 4};
    const geometry = new THREE.ExtrudeBufferGeometry(outline, {depth, ...bevel, curveSegments: 24});
    // The outline's x, y and the way of extrusion become x, z and -y.
    geometry.translate(0, 0, -depth / 2).rotateX(Math.PI / 2).translate(0, 0, -shape.radius);
    return {
        geometry,
        tall: 0.55 * shape.radius,
        width: 2 * shape.radius * Math.sin(half),
        mark: 0.45 * shape.radius * Math.sin(half)
    };
}

function sphereHead(shape) {
    const geometry = new THREE.SphereBufferGeometry(shape.radius, 48, 32).translate(0, 0, -shape.radius);
    return {geometry, tall: 2 * shape.radius, width: 2 * shape.radius};
}

const heads = {
    linear: linearHead,
    curved: curvedHead,
    sphere: sphereHead
};

const GRIP = 0.035;  // m: how long the handle is

// A group of meshes in the probe's frame; the head's geometry may be given.
export function probeGroup(shape, given) {
    const head = shape ? heads[shape.kind](shape) : {geometry: given, tall: 0.03, width: 0.03};
    if (given) head.geometry = given;
    const group = new THREE.Group();
    const grey = new THREE.MeshPhongMaterial({color: 0xc9cfd4, shininess: 40, side: THREE.DoubleSide});
    const dark = new THREE.MeshPhongMaterial({color: 0x5b646c, shininess: 20});
    const mark = new THREE.MeshBasicMaterial({color: 0xf2a93b});
    group.add(new THREE.Mesh(head.geometry, grey));
    const wide = Math.min(0.32 * head.width, 0.016);
    const flat = Math.min((0.6 * ((shape && shape.thickness) || head.width)) / wide, 1);
    const grip = new THREE.CylinderBufferGeometry(wide, 0.75 * wide, GRIP, 24);
    grip.rotateX(-Math.PI / 2).scale(1, flat, 1).translate(0, 0, -head.tall - 0.5 * GRIP);
    group.add(new THREE.Mesh(grip, dark));
    const size = Math.max(0.08 * head.width, 0.0015);
    const bump =
        new THREE.SphereBufferGeometry(size, 16, 12).translate(head.mark || 0.36 * head.width, 0, -head.tall - 0.002);
    group.add(new THREE.Mesh(bump, mark));
    return group;
}

// What the skin's shader needs to know where a probe touches: see distance_to_probe in shaders.js.
export function shapeUniforms(shape) {
    if (!shape) return {kind: 0, size: [0, 0, 0, 0]};
    if (shape.kind === "sphere") return {kind: 1, size: [shape.radius, 0, 0, 0]};
    if (shape.kind === "linear") return {kind: 2, size: [shape.width, shape.thickness, shape.edge, 0]};
    return {kind: 3, size: [shape.radius, shape.thickness, shape.edge, shape.angle / 2]};
}

function sector(x, y, radius, angle) {
    const aside = Math.abs(x);
    const [sideX, sideY] = [Math.sin(angle), Math.cos(angle)];
    const along = Math.min(Math.max(aside * sideX + y * sideY, 0), radius);
    const beside = Math.hypot(aside - along * sideX, y - along * sideY);
    return Math.max(Math.hypot(aside, y) - radius, beside * Math.sign(sideY * aside - sideX * y));
}

// distance_to_probe of shaders.js, m: of a place in the probe's frame; kind and size as shapeUniforms() has them.
export function distanceToProbe(kind, size, x, y, z) {
    if (kind === 1) return Math.hypot(x, y, z + size[0]) - size[0];
    if (kind === 2) {
        const [wide, flat, edge] = size;
        const tall = Math.max(wide, flat);
        const q = [[x, wide], [y, flat], [z + 0.5 * tall, tall]].map(([at, long]) => Math.abs(at) - 0.5 * long + edge);
        return Math.hypot(...q.map((far) => Math.max(far, 0))) + Math.min(Math.max(...q), 0) - edge;
    }
    if (kind === 3) {
        const [radius, flat, edge, angle] = size;
        const q = [sector(x, z + radius, radius, angle) + edge, Math.abs(y) - 0.5 * flat + edge];
        return Math.min(Math.max(...q), 0) + Math.hypot(...q.map((far) => Math.max(far, 0))) - edge;
    }
    return 1;
}
