# "#nodes x 3" in a comment is a shape; Doxygen would take it for a link.
/^ *(\/\/|\/?\*)|\/\/\/</s/#([a-zA-Z])/\\#\1/g
