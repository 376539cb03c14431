// Small pieces of the page: elements, rows of a slider and a number, numbers as they are shown.

// element("button", {class: "wide", title: "..."}, "text", child): properties that begin with "on" are listeners.
export function element(tag, properties = {}, ...children) {
    const made = document.createElement(tag);
    for (const [key, value] of Object.entries(properties)) {
        if (value === null || value === undefined || value === false) continue;
        if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
        else if (key === "class") made.className = value;
        else if (key === "value") made.value = value;
        else made.setAttribute(key, value === true ? "" : value);
    }
    made.append(...children.filter((child) => child !== null && child !== undefined));
    return made;
}

export const byId = (id) => document.getElementById(id);

// As many digits as a reader needs: 12.3, 0.123, 1.2e-5.
export function figures(value, digits = 3) {
    if (!Number.isFinite(value)) return "–";
    if (value !== 0 && Math.abs(value) < 10 ** -digits) return value.toExponential(1);
    const whole = Math.abs(value) < 1 ? 1 : Math.floor(Math.log10(Math.abs(value))) + 1;
    return value.toFixed(Math.max(digits - whole, 0));
}

// A number as a line of text carries it: all digits, never an exponent without need.
export const exactly = (value) => String(Number(value.toPrecision(9)));

const HOLD = 600;  // ms: for so long after the hand's last move, what comes from elsewhere waits

// A row of a name, a slider and a number with its unit. `change` gets the number as it moves; put() shows a value,
// set() one that came from elsewhere, which may be older than what the hand has just chosen: then it waits.
export class Slider {
    constructor({label, unit = "", min, max, step, value = 0, help = "", change, named = label}) {
        const id = `slider-${named.replace(/\W+/g, "-")}`;
        const title = `${help || label}${unit ? ` (${unit})` : ""}, ${min} to ${max}`;
        const common = {min, max, step, value, title};
        this.range = element("input", {...common, type: "range", id, "aria-label": `${named}, ${unit}`});
        this.number = element("input", {...common, type: "number", "aria-label": `${named} as a number, ${unit}`});
        this.row = element("div", {class: "slider", title}, element("label", {"for": id}, label), this.range,
            this.number, element("span", {class: "unit"}, unit));
        this.change = change;
        this.range.addEventListener("input", () => this.moved(this.range, this.number));
        this.number.addEventListener("input", () => this.moved(this.number, this.range));
    }

    moved(from, to) {
        const value = Number(from.value);
        if (from.value === "" || !Number.isFinite(value)) return;
        to.value = value;
        this.touched = performance.now();
        this.change(value);
    }

    get value() {
        return Number(this.range.value);
    }

    set(value, digits = 4) {
        clearTimeout(this.later);
        const wait = (this.touched || -HOLD) + HOLD - performance.now();
        if (wait <= 0) this.put(value, digits);
        else this.later = setTimeout(() => this.put(value, digits), wait);
    }

    put(value, digits = 4) {
        if (!Number.isFinite(value)) return;
        const text = String(Number(value.toFixed(digits)));
        if (document.activeElement !== this.number) this.number.value = text;
        if (!this.range.matches(":active")) this.range.value = text;
    }
}

// A canvas as large as its room, painted when draw() has been called or the room's size has changed, once for each
// picture of the screen at most. Who extends it has paint(to, width, height), which draws with `to` in CSS pixels.
export class Drawing {
    constructor(canvas, room = canvas) {
        this.canvas = canvas;
        this.room = room;
        this.waiting = [];
        new ResizeObserver(() => this.draw()).observe(room);
    }

    draw() {
        if (this.asked) return;
        this.asked = true;
        requestAnimationFrame(() => {
            this.asked = false;
            this.fit();
            for (const call of this.waiting.splice(0)) setTimeout(call);
        });
    }

    // Calls once the browser has put on the screen what is asked for; at once where nothing is.
    after(call) {
        if (this.asked) this.waiting.push(call);
        else call();
    }

    // A size that is set takes new memory.
    fit() {
        const ratio = window.devicePixelRatio || 1;
        const [width, height] = [this.room.clientWidth, this.room.clientHeight];
        if (!width || !height) return;
        const [columns, rows] = [Math.round(width * ratio), Math.round(height * ratio)];
        if (this.canvas.width !== columns || this.canvas.height !== rows)
            [this.canvas.width, this.canvas.height] = [columns, rows];
        const to = this.canvas.getContext("2d");
        to.setTransform(ratio, 0, 0, ratio, 0, 0);
        to.clearRect(0, 0, width, height);
        this.paint(to, width, height);
    }
}

// At most one call in `each` ms, of which the last always comes.
export function paced(each, call) {
    let last = -Infinity;
    let waiting = null;
    let newest;
    const now = () => {
        waiting = null;
        last = performance.now();
        call(...newest);
    };
    return (...words) => {
        newest = words;
        if (waiting !== null) return;
        const wait = last + each - performance.now();
        if (wait <= 0) now();
        else waiting = setTimeout(now, wait);
    };
}

// The text of a list, replaced only where it differs, so that what has the focus keeps it.
export function renew(parent, key, make) {
    if (parent.dataset.key === key) return false;
    parent.dataset.key = key;
    parent.replaceChildren(...make());
    return true;
}
