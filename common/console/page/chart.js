// A strip chart: the last seconds of one number, drawn from the right.

import {niceStep} from "./image.js";
import {Drawing, figures} from "./widgets.js";

const SPAN = 10;  // s
const INK = "#8b979f";
const LINE = "#7cc4e0";

export class Chart extends Drawing {
    constructor(canvas, unit) {
        super(canvas);
        this.unit = unit;
        this.points = [];  // [s, value]
    }

    // Times that go back begin a new strip.
    add(time, value) {
        const last = this.points[this.points.length - 1];
        if (last && time < last[0]) this.points = [];
        this.points.push([time, value]);
        while (this.points[0][0] < time - SPAN) this.points.shift();
        this.draw();
    }

    clear() {
        this.points = [];
        this.draw();
    }

    paint(to, width, height) {
        const em = parseFloat(getComputedStyle(this.canvas).fontSize);
        const most = Math.max(...this.points.map(([, value]) => value), 1e-3);
        const step = niceStep(most / 2);
        const top = step * Math.ceil((1.05 * most) / step);
        const frame = {left: 2.6 * em, right: width - 0.3 * em, top: 0.6 * em, bottom: height - 1.3 * em};
        const y = (value) => frame.bottom - (value / top) * (frame.bottom - frame.top);
        this.grid(to, frame, em, step, top, y);
        this.line(to, frame, em, y);
    }

    grid(to, frame, em, step, top, y) {
        Object.assign(to, {fillStyle: INK, strokeStyle: "#2b3238", textBaseline: "middle", lineWidth: 1});
        to.font = `${0.75 * em}px system-ui, sans-serif`;
        to.textAlign = "right";
        to.beginPath();
        for (let i = 0; i * step <= top * 1.0001; i++) {
            to.moveTo(frame.left, y(i * step));
            to.lineTo(frame.right, y(i * step));
            to.fillText(figures(i * step, 2), frame.left - 0.3 * em, y(i * step));
        }
        to.stroke();
        to.textAlign = "left";
        to.fillText(`${this.unit}, last ${SPAN} s`, frame.left, frame.bottom + 0.8 * em);
    }

    line(to, frame, em, y) {
        if (!this.points.length) return;
        const newest = this.points[this.points.length - 1][0];
        const x = (time) => frame.right - ((newest - time) / SPAN) * (frame.right - frame.left);
        Object.assign(to, {strokeStyle: LINE, lineWidth: Math.max(em / 8, 1.5), lineJoin: "round"});
        to.beginPath();
        for (const [time, value] of this.points) to.lineTo(x(time), y(value));
        to.stroke();
    }
}
