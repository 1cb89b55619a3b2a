"""GDB pretty printers for Entity, ComponentMask and World. In gdb: source runtime/ecs/debug/gdb_printers.py"""
import gdb


def vector_items(vector):
    """Elements of a std::vector of anything but bool."""
    at, end = vector["_M_impl"]["_M_start"], vector["_M_impl"]["_M_finish"]
    while at != end:
        yield at.dereference()
        at += 1


def vector_size(vector):
    return int(vector["_M_impl"]["_M_finish"] - vector["_M_impl"]["_M_start"])


def component_name(component):
    # Cast: the library itself may have no debug information.
    infos = gdb.parse_and_eval("*(penumbra::ecs::ComponentInfo**)&'penumbra::ecs::debuggedComponents'")
    if int(infos) == 0:
        return str(component)
    name = infos[component]["name"]
    return name["_M_str"].string(length=int(name["_M_len"]))


def mask_names(mask):
    words = mask["m_words"]["_M_elems"]
    first, last = words.type.strip_typedefs().range()
    ids = [64 * w + bit for w in range(first, last + 1) for bit in range(64) if int(words[w]) >> bit & 1]
    return [component_name(i) for i in ids]


class EntityPrinter:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        index, generation = int(self.value["index"]), int(self.value["generation"])
        if generation == 0:
            return "null"
        return f"deferred {index}" if generation >> 31 else f"{index}#{generation}"


class MaskPrinter:
    def __init__(self, value):
        self.value = value

    def to_string(self):
        return "{" + ", ".join(mask_names(self.value)) + "}"


class WorldPrinter:
    """Totals; one child per archetype that has rows."""

    def __init__(self, value):
        self.value = value

    def archetypes(self):
        return [p.dereference() for p in vector_items(self.value["m_archetypes"])]

    def to_string(self):
        table = self.value["m_entities"]
        count = vector_size(table["m_records"]) - int(table["m_freeCount"]) - int(table["m_retired"])
        version = int(self.value["m_stamp"]["version"])
        return f"World of {count} entities, {len(self.archetypes())} archetypes, version {version}"

    def children(self):
        for archetype in self.archetypes():
            rows = int(archetype["m_shape"]) & 0xFFFFFFFF
            if rows > 0:
                names = ", ".join(mask_names(archetype["m_mask"])) or "-"
                yield f"archetype {int(archetype['m_index'])}", f"{rows} rows of {names}"


def build():
    from gdb.printing import RegexpCollectionPrettyPrinter
    printers = RegexpCollectionPrettyPrinter("penumbra-ecs")
    printers.add_printer("Entity", "^penumbra::ecs::Entity$", EntityPrinter)
    printers.add_printer("ComponentMask", "^penumbra::ecs::ComponentMask$", MaskPrinter)
    printers.add_printer("World", "^penumbra::ecs::World$", WorldPrinter)
    return printers


from gdb.printing import register_pretty_printer  # noqa: E402

register_pretty_printer(gdb.current_objfile(), build(), replace=True)
