// A face: its muscles, its points pulled with the mouse, gravity, and what it is coloured by. Each pull is a spring of
// tled-run from a point of the tissue to the hand.

import {
    CylinderBufferGeometry,
    Group,
    Mesh,
    MeshBasicMaterial,
    Plane,
    Quaternion,
    SphereBufferGeometry,
    Vector3
} from "/three/build/three.module.js";

import {Surface} from "./cast.js";
import {drawScale} from "./colours.js";
import {byId, element, exactly, figures, paced, renew, Slider} from "./widgets.js";

const SIDES = ["expression", "left", "right", "middle", ""];
const UP = new Vector3(0, 1, 0);

// What colourings are called; others by their own names.
const COLOURINGS = {
    own: "its own colour",
    stress: "von Mises stress",
    stretch: "largest stretch",
    "stretch.fibre": "stretch of fibres",
    energy: "strain energy"
};
const called = (name) => COLOURINGS[name] || name;

// What two muscles of the two sides have in common: their name without the side.
export const pairOf = (name) => name.toLowerCase().replace(/(^|[_\-. ])(left|right|l|r)(?=$|[_\-. ])/g, "$1");

export class Face {
    // send(line): to the server.
    constructor(view, send) {
        this.view = view;
        this.send = send;
        this.active = false;
        this.sliders = new Map();
        this.senders = new Map();
        this.pulls = new Map();
        this.released = new Set();  // of which the server's state has not told yet
        this.next = 1;
        this.colouring = "own";
        this.listen(view.canvas);
        this.build();
        view.drawn.push(() => this.labels());
    }

    // ---- muscles

    set(state) {
        this.active = state.kind === "face";
        const muscles = state.muscles || [];
        renew(byId("muscle-list"), JSON.stringify(muscles.map((m) => [m.name, m.side])), () => this.groups(muscles));
        for (const muscle of muscles) this.sliders.get(muscle.name).set(100 * muscle.level, 1);
        this.showGravity(state);
        this.setPulls(state.pulls || []);
        this.offerColours(state);
    }

    groups(muscles) {
        this.sliders.clear();
        const sides = SIDES.filter((side) => muscles.some((m) => (m.side || "") === side));
        return sides.map((side) => element("fieldset", {}, element("legend", {}, side || "muscles"),
                             ...muscles.filter((m) => (m.side || "") === side).map((m) => this.muscle(m))));
    }

    muscle({name, level}) {
        const help = `How much ${name} contracts, in % of its full strength`;
        const change = (value) => this.contract(name, value);
        const slider =
            new Slider({label: name, unit: "%", min: 0, max: 100, step: 1, value: 100 * level, help, change});
        this.sliders.set(name, slider);
        return slider.row;
    }

    contract(name, value) {
        this.level(name, value);
        if (!byId("both-sides").checked) return;
        for (const other of this.sliders.keys()) {
            if (other === name || pairOf(other) !== pairOf(name)) continue;
            this.sliders.get(other).put(value, 1);
            this.level(other, value);
        }
    }

    level(name, value) {
        if (!this.senders.has(name))
            this.senders.set(name, paced(40, (v) => this.send(`now contract ${name} ${exactly(v / 100)}`)));
        this.senders.get(name)(value);
    }

    relax() {
        for (const [name, slider] of this.sliders) {
            if (slider.value === 0) continue;
            slider.put(0);
            this.level(name, 0);
        }
    }

    // ---- gravity, and how a pull pulls

    build() {
        byId("drag-turns")
            .addEventListener("click", () => byId("drag-turns").setAttribute("aria-pressed", !this.turns()));
        byId("relax").addEventListener("click", () => this.relax());
        for (const id of ["gx", "gy", "gz"]) byId(id).addEventListener("change", () => this.sendGravity());
        byId("gravity-down").addEventListener("click", () => this.earth());
        byId("gravity-none").addEventListener("click", () => this.gravity([0, 0, 0]));
        const keep = () => {};
        const help = "Of the tissue that is pulled along: nodes at rest this near to the point";
        this.radius = new Slider({
            label: "Radius",
            unit: "mm",
            min: 1,
            max: 30,
            step: 0.5,
            value: 6,
            help,
            change: keep,
            named: "pull radius"
        });
        const stiff = "Of the spring from the tissue to the hand";
        this.stiffness = new Slider({
            label: "Stiffness",
            unit: "N/m",
            min: 1,
            max: 500,
            step: 1,
            value: 60,
            help: stiff,
            change: keep,
            named: "pull stiffness"
        });
        byId("pull-settings").replaceChildren(this.radius.row, this.stiffness.row);
        byId("release-all").addEventListener("click", () => [...this.pulls.keys()].forEach((id) => this.release(id)));
        byId("colouring").addEventListener("change", () => this.colourBy(byId("colouring").value));
        drawScale(byId("legend-scale"));
    }

    earth() {
        this.gravity(this.view.up.map((x) => Number((-9.81 * x).toFixed(4)) + 0));
    }

    gravity(vector) {
        ["gx", "gy", "gz"].forEach((id, i) => (byId(id).value = vector[i]));
        this.sendGravity();
    }

    showGravity(state) {
        const setting = ((state.tool || {}).settings || {}).gravity;
        const words = String((setting || {}).value || "").split(",");
        if (words.length !== 3 || words.join() === this.toldGravity) return;
        this.toldGravity = words.join();
        ["gx", "gy", "gz"].forEach((id, i) => {
            if (document.activeElement !== byId(id)) byId(id).value = Number(words[i]);
        });
    }

    sendGravity() {
        const vector = ["gx", "gy", "gz"].map((id) => Number(byId(id).value));
        if (vector.every(Number.isFinite)) this.send(`now gravity ${vector.map(exactly).join(",")}`);
    }

    // ---- pulls

    listen(canvas) {
        canvas.addEventListener("pointerdown", (event) => this.down(event));
        canvas.addEventListener("pointermove", (event) => this.move(event));
        canvas.addEventListener("pointerup", (event) => this.up(event));
        canvas.addEventListener("pointercancel", (event) => this.up(event));
    }

    // A point of the tissue, where it is now.
    touch(event) {
        const item = this.view.touchable();
        if (!item || !item.visible) return null;
        const ray = this.view.ray(event.clientX, event.clientY);
        const hit = new Surface(item.positionsNow(), item.triangles).cast(ray.origin, ray.direction);
        return hit && {item, hit};
    }

    // With the left button alone, on the tissue; else the view has it.
    down(event) {
        if (!this.active || this.turns() || event.button !== 0 || event.ctrlKey || event.shiftKey || event.metaKey)
            return;
        const touched = this.touch(event);
        if (!touched) return;
        const {item, hit} = touched;
        const rest = mix(hit, (vertex) => item.placeAtRest(vertex));
        const id = this.newName();
        const pull = {
            id,
            item,
            hit,
            rest,
            target: hit.point.clone(),
            radius: this.radius.value / 1000,
            stiffness: this.stiffness.value
        };
        const facing = this.view.camera.getWorldDirection(new Vector3());
        this.hand = {pull, plane: new Plane().setFromNormalAndCoplanarPoint(facing, hit.point)};
        this.add(pull);
        this.view.orbit.enabled = false;
        this.view.canvas.setPointerCapture(event.pointerId);
        event.preventDefault();
        this.view.canvas.focus();
        this.tell = paced(15, () => this.sendPull(pull));
        this.tell();
    }

    turns() {
        return byId("drag-turns").getAttribute("aria-pressed") === "true";
    }

    newName() {
        while (this.pulls.has(`pull${this.next}`)) this.next++;
        return `pull${this.next++}`;
    }

    move(event) {
        if (!this.hand) return;
        const target = new Vector3();
        if (!this.view.ray(event.clientX, event.clientY).intersectPlane(this.hand.plane, target)) return;
        this.hand.pull.target.copy(target);
        this.place(this.hand.pull);
        this.tell();
    }

    up(event) {
        if (!this.hand) return;
        const {pull} = this.hand;
        this.hand = null;
        this.view.orbit.enabled = true;
        this.view.canvas.releasePointerCapture(event.pointerId);
        if (!byId("hold-pulls").checked) this.release(pull.id);
        this.list();
    }

    sendPull(pull) {
        const {id, rest, radius, target, stiffness} = pull;
        if (this.pulls.get(id) !== pull) return;  // it was released meanwhile
        const words = (v) => v.toArray().map(exactly).join(",");
        this.send(`pull ${id} ${words(rest)} ${exactly(radius)} ${words(target)} ${exactly(stiffness)}`);
    }

    release(id) {
        this.send(`release ${id}`);
        this.released.add(id);
        this.remove(id);
    }

    add(pull) {
        pull.group = new Group();
        const material = new MeshBasicMaterial({color: 0xf2a93b});
        const size = this.view.size() / 120;
        pull.rod = new Mesh(new CylinderBufferGeometry(size / 3, size / 3, 1, 12), material);
        pull.knob = new Mesh(new SphereBufferGeometry(size, 16, 12), material);
        pull.group.add(pull.rod, pull.knob);
        pull.label = element("span", {class: "pull-label"});
        byId("labels-over").append(pull.label);
        this.view.scene.add(pull.group);
        this.pulls.set(pull.id, pull);
        this.place(pull);
        this.list();
    }

    remove(id) {
        const pull = this.pulls.get(id);
        if (!pull) return;
        this.view.scene.remove(pull.group);
        pull.label.remove();
        this.pulls.delete(id);
        this.list();
        this.view.request();
    }

    // Where the point that is pulled is now.
    pointOf({item, hit}) {
        return mix(hit, (vertex) => item.placeNow(vertex));
    }

    place(pull) {
        const from = this.pointOf(pull);
        const way = pull.target.clone().sub(from);
        pull.force = pull.stiffness * way.length();
        pull.rod.position.copy(from).addScaledVector(way, 0.5);
        pull.rod.scale.set(1, Math.max(way.length(), 1e-6), 1);
        pull.rod.quaternion.copy(new Quaternion().setFromUnitVectors(UP, way.length() > 0 ? way.normalize() : UP));
        pull.knob.position.copy(pull.target);
        pull.label.textContent = `${figures(pull.force, 2)} N`;
        this.view.request();
    }

    labels() {
        const frame = this.view.canvas.getBoundingClientRect();
        for (const pull of this.pulls.values()) {
            const [x, y] = this.view.project(pull.target);
            pull.label.style.transform = `translate(${x - frame.left}px, ${y - frame.top}px)`;
        }
    }

    list() {
        const rows = [...this.pulls.values()].map(
            (pull) => element("div", {class: "pull"}, element("span", {}, pull.id),
                element("button", {title: `Let go of ${pull.id}`, onclick: () => this.release(pull.id)}, "Release")));
        byId("pull-list").replaceChildren(...rows);
        byId("release-all").hidden = this.pulls.size < 2;
    }

    // What the server has: another page's pulls come, and those that were released go. What a hand holds stays.
    setPulls(theirs) {
        const names = new Set(theirs.map((pull) => pull.id));
        for (const id of this.released)
            if (!names.has(id)) this.released.delete(id);
        for (const id of [...this.pulls.keys()])
            if (!names.has(id) && !this.isHeld(id) && this.pulls.get(id).told) this.remove(id);
        for (const each of theirs) {
            const mine = this.pulls.get(each.id) || (!this.released.has(each.id) && this.adopt(each));
            if (!mine) continue;
            mine.told = true;
            if (!this.isHeld(each.id)) mine.target.fromArray(each.target);
            this.place(mine);
        }
    }

    isHeld(id) {
        return Boolean(this.hand && this.hand.pull.id === id);
    }

    // A pull that another page made: its line begins at the vertex nearest to its point.
    adopt({id, point, radius, target, stiffness}) {
        const item = this.view.touchable();
        if (!item) return null;
        const rest = new Vector3().fromArray(point);
        let best = 0;
        for (let i = 1; i < item.count; i++)
            if (item.placeAtRest(i).distanceToSquared(rest) < item.placeAtRest(best).distanceToSquared(rest)) best = i;
        const hit = {corners: [best, best, best], weights: [1, 0, 0]};
        this.add({id, item, hit, rest, target: new Vector3().fromArray(target), radius, stiffness});
        return this.pulls.get(id);
    }

    setGeometry() {
        this.hand = null;
        for (const id of [...this.pulls.keys()]) this.remove(id);
        this.most = 0;
    }

    // After each message of positions.
    moved() {
        for (const pull of this.pulls.values()) this.place(pull);
        this.recolour();
    }

    // ---- colours

    offerColours(state) {
        const offered = state.colours || [];
        const names = ["own", "displacement", ...offered.filter((name) => name !== "displacement")];
        renew(
            byId("colouring"), names.join(), () => names.map((name) => element("option", {value: name}, called(name))));
        this.units = state.units || {};
        if (state.colour && state.colour !== this.toldColour) this.setColouring(state.colour);
        this.toldColour = state.colour;
        byId("colouring").value = names.includes(this.colouring) ? this.colouring : "own";
    }

    // For all pages: the server's state has it.
    colourBy(name) {
        this.send(`colour ${name}`);
        this.setColouring(name);
    }

    setColouring(name) {
        this.colouring = name;
        this.most = 0;
        this.recolour();
    }

    recolour() {
        const item = this.view.touchable();
        const own = this.colouring === "own" || !item;
        byId("legend").hidden = own;
        byId("colouring").value = this.colouring;
        if (own) {
            this.view.colourBy("own", 0, 1);
            return;
        }
        if (this.colouring === "displacement") this.byDisplacement(item);
        else this.byValues(item);
    }

    // The scale's end only grows, in steps, so that colours hold still.
    byDisplacement(item) {
        const most = item.largestMoved();
        if (most > this.most || most < this.most / 4) this.most = roundUp(Math.max(most, 1e-4));
        this.view.colourBy("displacement", 0, this.most);
        this.legend("displacement", "0", figures(1000 * this.most, 2), "mm");
    }

    byValues(item) {
        const [low, high] = item.range || [0, 1];
        this.view.colourBy("values", low, high);
        this.legend(called(this.colouring), figures(low), figures(high), this.units[this.colouring] || "");
    }

    legend(name, low, high, unit) {
        byId("legend-name").textContent = unit ? `${name}, ${unit}` : name;
        byId("legend-low").textContent = low;
        byId("legend-high").textContent = high;
    }
}

function mix({corners, weights}, place) {
    const sum = new Vector3();
    corners.forEach((vertex, i) => sum.addScaledVector(place(vertex), weights[i]));
    return sum;
}

function roundUp(value) {
    const power = 10 ** Math.floor(Math.log10(value));
    return power * [1, 2, 5, 10].find((x) => x * power >= value * 0.9999);
}
