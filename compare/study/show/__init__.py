"""Tables, pictures and the page of a study, from what is stored alone."""
