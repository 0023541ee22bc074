// A table: rows that stay while what stands in them changes, sorted by a column, one of them chosen.

const value = (cell) => cell.order ?? cell.text;

export default {
  template: `<table>
    <thead><tr>
      <th v-for="(title, n) in columns" :key="n" :aria-sort="n !== column ? null : down ? 'descending' : 'ascending'">
        <button v-if="sortable" class="link" @click="sort(n)">{{ title }}</button><template v-else>{{ title }}</template>
      </th>
    </tr></thead>
    <tbody>
      <tr v-for="row in sorted" :key="row.key" :class="{ chosen: row.key === chosen }" @click="$emit('choose', row.key)">
        <td v-for="(cell, n) in row.cells" :key="n">
          <component :is="n === name ? 'button' : 'span'" :class="[cell.css, n === name ? 'link' : '']"
            :aria-pressed="n === name ? row.key === chosen : null" :title="cell.title">{{ cell.text }}</component>
          <div v-if="cell.more" class="soft">{{ cell.more }}</div>
        </td>
      </tr>
    </tbody>
  </table>`,
  // `name`: the column whose cells are buttons that choose the row by key; -1: nothing can be chosen.
  props: { columns: Array, rows: Array, chosen: String, name: Number, sortable: Boolean },
  data: () => ({ column: -1, down: false }),
  computed: {
    sorted() {
      if (this.column < 0) return this.rows;
      const way = this.down ? -1 : 1;
      return [...this.rows].sort((one, other) => {
        const [a, b] = [value(one.cells[this.column]), value(other.cells[this.column])];
        return a < b ? -way : a > b ? way : 0;
      });
    },
  },
  watch: {
    // Twice: what explains the chosen row is laid out in between, and takes of the table's height.
    chosen() {
      const look = () => this.$el.querySelector("tr.chosen")?.scrollIntoView({ block: "nearest" });
      requestAnimationFrame(() => requestAnimationFrame(look));
    },
  },
  methods: {
    sort(column) {
      this.down = column === this.column && !this.down;
      this.column = column;
    },
  },
};
