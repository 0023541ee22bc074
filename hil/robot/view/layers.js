// A window on layers of SVG: the wheel or two fingers zoom, a drag on the ground shifts.  What is done to something of
// the class "grip", and a tap on the ground, is told to the page in units of the picture.

const CLICK_PX = 5;
const TELL_MS = 100;

export default {
  template: `<div><slot></slot></div>`,
  // So many pixels at the edges are taken by buttons and numbers; what fits stays clear of them.
  props: { extent: Array, above: Number, below: Number, left: Number },
  mounted() {
    this.fitted = true;
    this.scale = 1;
    this.x = this.y = 0;
    this.fingers = new Map();
    this.grip = false;
    const element = this.$el;
    this.sizes = new ResizeObserver(() => (this.fitted ? this.fit() : this.apply()));
    this.sizes.observe(element);
    element.addEventListener("wheel", this.wheel, { passive: false });
    element.addEventListener("pointerdown", this.down);
    element.addEventListener("pointermove", this.move);
    element.addEventListener("pointerup", this.up);
    element.addEventListener("pointercancel", this.cancel);
    this.fit();
  },
  // A page's update renders every component.  To apply is to have the browser lay out the page at once, so only a new
  // layer is a reason.
  updated() {
    if (this.$el.children.length !== this.layers) this.apply();
  },
  watch: {
    extent() {
      if (this.fitted) this.fit();
    },
  },
  beforeUnmount() {
    this.sizes.disconnect();
    clearTimeout(this.telling);
  },
  methods: {
    // Everything in sight, in the middle.
    fit() {
      const [x, y, width, height] = this.extent;
      const element = this.$el;
      this.fitted = true;
      const [above, below, left] = [this.above || 0, this.below || 0, this.left || 0];
      const wide = Math.max(1, element.clientWidth - left);
      const high = Math.max(1, element.clientHeight - above - below);
      this.scale = Math.min(wide / width, high / height) || 1;
      this.x = x + width / 2 - left / 2 / this.scale;
      this.y = y + height / 2 + (below - above) / 2 / this.scale;
      this.apply();
    },
    // Zoom about a place of the screen; without one, about the middle.
    zoom(factor, at) {
      const before = at || [this.x, this.y];
      const [, , width] = this.extent;
      const whole = this.$el.clientWidth / width;
      const scale = Math.min(Math.max(this.scale * factor, whole / 4), whole * 40);
      this.x = before[0] + ((this.x - before[0]) * this.scale) / scale;
      this.y = before[1] + ((this.y - before[1]) * this.scale) / scale;
      this.scale = scale;
      this.fitted = false;
      this.apply();
    },
    // Have a point of the picture in the middle.
    centre(x, y) {
      this.x = x;
      this.y = y;
      this.fitted = false;
      this.apply();
    },
    apply() {
      const { clientWidth, clientHeight } = this.$el;
      if (!clientWidth || !clientHeight) return;
      const width = clientWidth / this.scale;
      const height = clientHeight / this.scale;
      const box = [this.x - width / 2, this.y - height / 2, width, height];
      this.layers = this.$el.children.length;
      for (const layer of this.$el.children) layer.setAttribute("viewBox", box.join(" "));
      this.$el.style.setProperty("--unit", 1 / this.scale);
      this.seen = box;
      if (!this.telling) {
        this.telling = setTimeout(() => {
          this.telling = 0;
          this.$emit("seen", { box: this.seen, unit: 1 / this.scale });
        }, TELL_MS);
      }
    },
    place(e) {
      const frame = this.$el.getBoundingClientRect();
      const { clientWidth, clientHeight } = this.$el;
      return [
        this.x + (e.clientX - frame.left - clientWidth / 2) / this.scale,
        this.y + (e.clientY - frame.top - clientHeight / 2) / this.scale,
      ];
    },
    tell(what, e) {
      const [x, y] = this.place(e);
      this.$emit("hand", { what, x, y, shift: e.shiftKey });
    },
    wheel(e) {
      e.preventDefault();
      this.zoom(Math.exp(-Math.max(-200, Math.min(200, e.deltaY)) / 400), this.place(e));
    },
    down(e) {
      if (e.button !== 0) return;
      this.$el.setPointerCapture(e.pointerId);
      this.fingers.set(e.pointerId, [e.clientX, e.clientY]);
      this.begun = [e.clientX, e.clientY];
      this.shifted = this.fingers.size > 1;
      this.grip = this.fingers.size === 1 && e.target.closest(".grip") !== null;
      if (this.grip) this.tell("take", e);
    },
    move(e) {
      const last = this.fingers.get(e.pointerId);
      if (last === undefined) return;
      const now = [e.clientX, e.clientY];
      if (this.grip) {
        this.fingers.set(e.pointerId, now);
        this.tell("drag", e);
        return;
      }
      if (this.fingers.size === 2) {
        const [other] = [...this.fingers].filter(([id]) => id !== e.pointerId).map(([, at]) => at);
        const apart = (a) => Math.hypot(a[0] - other[0], a[1] - other[1]);
        const middle = { clientX: (now[0] + other[0]) / 2, clientY: (now[1] + other[1]) / 2 };
        this.zoom(apart(now) / Math.max(1, apart(last)), this.place(middle));
      } else if (this.shifted || Math.hypot(now[0] - this.begun[0], now[1] - this.begun[1]) > CLICK_PX) {
        if (!this.shifted) this.$emit("shifted");
        this.shifted = true;
        this.centre(this.x - (now[0] - last[0]) / this.scale, this.y - (now[1] - last[1]) / this.scale);
      } else {
        return;
      }
      this.fingers.set(e.pointerId, now);
    },
    up(e) {
      if (!this.fingers.delete(e.pointerId)) return;
      if (this.grip) this.tell("drop", e);
      else if (!this.shifted) this.tell("tap", e);
      this.grip = false;
    },
    cancel(e) {
      this.fingers.delete(e.pointerId);
      if (this.grip) this.tell("leave", e);
      this.grip = false;
      this.shifted = true;
    },
  },
};
