// Read.java FILE -- as read.py, with jhdf.
import io.jhdf.HdfFile;
import io.jhdf.api.Dataset;
import io.jhdf.api.Node;
import java.nio.file.Paths;

class Read {
  static void print(StringBuilder out, Object value) {
    if (value.getClass().isArray())
      for (int i = 0; i < java.lang.reflect.Array.getLength(value); i++)
        print(out, java.lang.reflect.Array.get(value, i));
    else out.append(' ').append(((Number) value).doubleValue());
  }

  public static void main(String[] names) {
    try (HdfFile file = new HdfFile(Paths.get(names[0]))) {
      for (Node node : file.getChildren().values()) {
        if (!(node instanceof Dataset)) continue;
        StringBuilder out = new StringBuilder();
        try {
          print(out, ((Dataset) node).getData());
        } catch (Exception error) {
          out.append('!').append(error.getMessage());
        }
        System.out.println(node.getName() + "\t" + out.toString().strip());
      }
    }
  }
}
