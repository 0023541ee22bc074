// Its content is the server's to change: the page's rendering leaves it alone.
export default {
  template: `<component :is="tag"></component>`,
  props: { content: String, tag: String },
  mounted() {
    this.show(this.content);
  },
  methods: {
    show(content) {
      this.$el.innerHTML = content;
    },
  },
};
