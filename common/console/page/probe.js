// The probe in the user's hand: dragged over the skin at rest, its face along the normal there; pushed in, tilted,
// rocked and turned from that. What is kept is where on the skin it stands and how it is held; the pose follows.
//
// tilt turns it about x (the image sweeps through the body), rock about y (within the image), turn about z.

import {Euler, Matrix4, Quaternion, Vector3} from "/three/build/three.module.js";

import {Surface} from "./cast.js";
import {reachOf} from "./shapes.js";
import {element, Slider} from "./widgets.js";

const degree = Math.PI / 180;
// ms: for so long after the hand's last move frames do not move what it holds; for so long where they lag behind it.
const FOLLOW = 400;
const LAG = 5000;
// A hand that drags says so at least so often, ms, also where it is still: a tracker waits for it.
const STILL = 300;

const LIMITS = {
    depth: [-30, 40],
    tilt: [-80, 80],
    rock: [-80, 80],
    turn: [-180, 180]
};
const STEPS = {
    depth: 0.1,
    tilt: 0.5,
    rock: 0.5,
    turn: 1
};
const ROWS = [
    [
        "depth", "Push in", "mm",
        "How far the face is pressed in from the skin at rest; the wheel over the probe, Page Up and Page Down"
    ],
    ["tilt", "Tilt", "°", "About the array: the image sweeps through the body; W and S, or shift and drag up and down"],
    ["rock", "Rock", "°", "Within the image; A and D, or shift and drag sideways"],
    ["turn", "Turn", "°", "About the beam; Q and E, or alt and drag sideways"],
];
const clamp = (value, [low, high]) => Math.min(Math.max(value, low), high);
const around = (angle) => angle - 360 * Math.floor((angle + 180) / 360);

export class Probe {
    // send(pose): an array of seven numbers.
    constructor(view, send) {
        this.view = view;
        this.send = send;
        this.surface = null;
        this.at = new Vector3();
        this.out = new Vector3(0, 0, 1);
        this.held = {depth: 0, tilt: 0, rock: 0, turn: 0};  // mm and degrees
        this.known = false;
        this.last = -Infinity;
        this.sliders = {};
        this.listen(view.canvas);
    }

    // ---- the skin

    setGeometry() {
        const item = this.view.touchable();
        this.surface = item ? new Surface(item.positions, item.triangles) : null;
        this.known = false;
    }

    radius() {
        return Math.max(0.7 * reachOf(this.view.shape), 0.006);
    }

    normalAt(hit) {
        return this.surface.normalAt(hit.point, this.radius()) || this.surface.faceNormal(hit);
    }

    // ---- pose

    // The way from the probe's frame, held straight, to the model's: z into the tissue, x along the model's x axis, or
    // its y axis where the face looks along x.
    straight(out) {
        const z = out.clone().negate();
        const x = Math.abs(out.x) < 0.95 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
        x.addScaledVector(z, -x.dot(z)).normalize();
        const y = z.clone().cross(x);
        return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(x, y, z));
    }

    pose() {
        const {depth, tilt, rock, turn} = this.held;
        const hand = new Quaternion().setFromEuler(new Euler(tilt * degree, rock * degree, turn * degree, "ZXY"));
        const q = this.straight(this.out).multiply(hand).normalize();
        const t = new Vector3(0, 0, depth / 1000).applyQuaternion(q).add(this.at);
        return [t.x, t.y, t.z, q.x, q.y, q.z, q.w];
    }

    hold(q) {
        const hand = this.straight(this.out).conjugate().multiply(q);
        const angles = new Euler().setFromQuaternion(hand, "ZXY");
        this.held.tilt = angles.x / degree;
        this.held.rock = angles.y / degree;
        this.held.turn = angles.z / degree;
    }

    // What a frame, or the state, says: the hand's numbers follow unless it has just moved.
    follow(pose) {
        const since = performance.now() - this.last;
        if (!pose || this.dragging || since < FOLLOW) return;
        const same = this.known && this.pose().every((x, i) => Math.abs(x - pose[i]) < 1e-9);
        this.arrived = this.arrived || same;
        if (same || (!this.arrived && since < LAG)) return;
        this.rebase(pose);
        this.view.poseProbe(pose);
        this.show();
    }

    // Where on the skin a pose stands, and how it is held there.
    rebase(pose) {
        const t = new Vector3().fromArray(pose, 0);
        const q = new Quaternion().fromArray(pose, 3);
        const z = new Vector3(0, 0, 1).applyQuaternion(q);
        const hit = this.surface && this.surface.nearestAlong(t, z);
        this.out = hit ? this.normalAt(hit) : z.clone().negate();
        if (this.out.dot(z) > 0) this.out.negate();
        this.at = hit ? hit.point : t;
        this.held.depth = 1000 * t.clone().sub(this.at).dot(z);
        this.hold(q);
        this.known = true;
    }

    // The hand has moved it.
    moved() {
        this.known = true;
        this.last = performance.now();
        this.arrived = false;  // no frame has shown this pose yet
        const pose = this.pose();
        this.view.poseProbe(pose);
        this.show();
        this.send(pose);
    }

    // To a place of the skin; how it is held goes along without a turn of its own.
    place(hit, facing) {
        const out = this.normalAt(hit);
        if (facing && out.dot(facing) > 0) out.negate();
        const before = this.straight(this.out);
        const rolled = new Quaternion().setFromUnitVectors(this.out, out).multiply(before);
        const about = this.straight(out).conjugate().multiply(rolled);
        this.held.turn = around(this.held.turn + (2 * Math.atan2(about.z, about.w)) / degree);
        this.out = out;
        this.at = hit.point;
        this.moved();
    }

    change(name, value) {
        this.held[name] = name === "turn" ? around(value) : clamp(value, LIMITS[name]);
        this.moved();
    }

    straighten() {
        Object.assign(this.held, {tilt: 0, rock: 0, turn: 0});
        this.moved();
    }

    // Over the skin by metres to the right and up as they are seen.
    slide(right, up) {
        if (!this.surface) return;
        const turn = this.view.camera.quaternion;
        const step = new Vector3(right, up, 0).applyQuaternion(turn);
        step.addScaledVector(this.out, -step.dot(this.out));
        if (step.length() < 1e-9) return;
        step.setLength(Math.hypot(right, up));
        const from = this.at.clone().add(step).addScaledVector(this.out, 0.03);
        const hit = this.surface.cast(from, this.out.clone().negate());
        if (hit) this.place(hit, this.out.clone().negate());
    }

    // ---- pointer

    listen(canvas) {
        canvas.addEventListener("pointerdown", (event) => this.down(event));
        canvas.addEventListener("pointermove", (event) => this.move(event));
        canvas.addEventListener("pointerup", (event) => this.up(event));
        canvas.addEventListener("pointercancel", (event) => this.up(event));
        canvas.addEventListener("wheel", (event) => this.wheel(event), {passive: false});
        canvas.addEventListener("dblclick", (event) => this.jump(event));
    }

    grabs(event) {
        if (!this.surface || !this.known) return false;
        return this.view.meetProbe(this.view.ray(event.clientX, event.clientY)) < Infinity;
    }

    down(event) {
        if (event.button !== 0 || !this.grabs(event)) return;
        const [x, y] = this.view.project(this.at);
        this.dragging = {x: event.clientX, y: event.clientY, off: [event.clientX - x, event.clientY - y]};
        this.still = setInterval(() => this.send(this.pose()), STILL);
        this.view.orbit.enabled = false;
        this.view.canvas.setPointerCapture(event.pointerId);
        this.view.canvas.focus();
        event.preventDefault();
    }

    move(event) {
        if (!this.dragging) {
            if (!event.buttons) this.view.canvas.classList.toggle("grabs", this.grabs(event));
            return;
        }
        const [x, y] = [event.clientX - this.dragging.x, event.clientY - this.dragging.y];
        [this.dragging.x, this.dragging.y] = [event.clientX, event.clientY];
        if (event.shiftKey || event.altKey) this.rotate(x, y, event.altKey);
        else this.drag(event);
    }

    rotate(x, y, turns) {
        if (turns) this.held.turn = around(this.held.turn + 0.5 * x);
        else {
            this.held.rock = clamp(this.held.rock + 0.3 * x, LIMITS.rock);
            this.held.tilt = clamp(this.held.tilt + 0.3 * y, LIMITS.tilt);
        }
        const [atX, atY] = this.view.project(this.at);
        this.dragging.off = [this.dragging.x - atX, this.dragging.y - atY];
        this.moved();
    }

    drag(event) {
        const [x, y] = this.dragging.off;
        const ray = this.view.ray(event.clientX - x, event.clientY - y);
        const hit = this.surface.cast(ray.origin, ray.direction);
        if (hit) this.place(hit, ray.direction);
    }

    up(event) {
        if (!this.dragging) return;
        this.dragging = null;
        clearInterval(this.still);
        this.view.orbit.enabled = true;
        this.view.canvas.releasePointerCapture(event.pointerId);
    }

    wheel(event) {
        if (!this.dragging && !this.grabs(event)) return;
        event.preventDefault();
        event.stopImmediatePropagation();
        this.change("depth", this.held.depth - Math.sign(event.deltaY) * (event.shiftKey ? 0.1 : 0.5));
    }

    // A double click calls it to a place.
    jump(event) {
        if (!this.surface) return;
        const ray = this.view.ray(event.clientX, event.clientY);
        const hit = this.surface.cast(ray.origin, ray.direction);
        if (hit) this.place(hit, ray.direction);
    }

    // ---- keys; true: it was one of these

    key(event) {
        const fine = event.shiftKey ? 0.2 : 1;
        const slides = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
        const changes = {
            PageDown: ["depth", 0.5],
            PageUp: ["depth", -0.5],
            w: ["tilt", -2],
            s: ["tilt", 2],
            a: ["rock", -2],
            d: ["rock", 2],
            q: ["turn", -3],
            e: ["turn", 3],
        }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (slides) this.slide(0.001 * fine * slides[0], 0.001 * fine * slides[1]);
        else if (changes) this.change(changes[0], this.held[changes[0]] + fine * changes[1]);
        else if (event.key === "Home") this.straighten();
        return Boolean(slides || changes || event.key === "Home");
    }

    // ---- the panel

    build() {
        for (const [name, label, unit, help] of ROWS) {
            const [min, max] = LIMITS[name];
            const change = (value) => this.change(name, value);
            this.sliders[name] = new Slider({label, unit, min, max, step: STEPS[name], help, change});
        }
        this.numbers = ["x", "y", "z"].map((axis, i) => this.placeNumber(axis, i));
        const straight = element("button",
            {title: "Stand it upright on the skin: tilt, rock and turn 0 (Home)", onclick: () => this.straighten()},
            "Straighten");
        const lift = element(
            "button", {title: "Lift it 10 mm off the skin", onclick: () => this.change("depth", -10)}, "Lift off");
        return [
            ...Object.values(this.sliders).map((slider) => slider.row),
            element("div", {class: "place"}, element("span", {}, "Place"), ...this.numbers,
                element("span", {class: "unit"}, "mm")),
            element("div", {class: "buttons"}, straight, lift),
        ];
    }

    // A number moves the probe as it is held.
    placeNumber(axis, i) {
        const title = `${axis} of the middle of the face, in the model's axes (mm)`;
        const input = element("input", {type: "number", step: 0.5, title, "aria-label": title});
        input.addEventListener("change", () => {
            if (input.value === "") return;
            const pose = this.pose();
            pose[i] = Number(input.value) / 1000;
            this.rebase(pose);
            this.moved();
        });
        return input;
    }

    show() {
        for (const [name, slider] of Object.entries(this.sliders))
            slider.put(this.held[name], name === "depth" ? 2 : 1);
        const pose = this.pose();
        (this.numbers || []).forEach((input, i) => {
            if (document.activeElement !== input) input.value = (Math.round(10000 * pose[i]) / 10 + 0).toFixed(1);
        });
    }
}
